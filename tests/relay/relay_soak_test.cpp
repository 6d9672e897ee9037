// Many rooms, users that come and go, loss, forged floods: nothing goes to the wrong member, no
// place is lost. TANDEM_RELAY_HOURS, TANDEM_RELAY_ROOMS and TANDEM_RELAY_FORGED (datagrams in 10
// ms) make it longer and larger.

#include <gtest/gtest.h>

#include "relay/relay_rig.h"

namespace tandem {
namespace {

using test::Bytes;
using test::RelayRig;
using test::VirtualNet;

constexpr std::uint16_t kMembers = 4;

/// The text of a datagram: room, sender, receiver.
Bytes write(int room, std::uint16_t from, std::uint16_t to) {
  Bytes bytes(32);
  bytes[0] = static_cast<std::uint8_t>(room), bytes[1] = static_cast<std::uint8_t>(from);
  bytes[2] = static_cast<std::uint8_t>(to), bytes[3] = static_cast<std::uint8_t>(room >> 8);
  return bytes;
}

/// Users of one relay, by a place for each id of each room.
class Crowd {
 public:
  Crowd(int rooms, std::uint64_t seed) : rooms_(rooms), random_(seed), rig_(makeSettings(rooms)) {
    rig_.net.conditions = {0.02, 0.01, 0.1, 0.01, 0.001};
    rig_.net.tap = [this](const Bytes& bytes, const Address&, const Address& to) {
      if (to == test::relayAddress()) overheard_ = bytes;
    };
  }

  /// Lets all act for ten milliseconds.
  void step() {
    for (int i = 0; i < rooms_ / 8 + 1; ++i) moveOne();
    sayAll();
    flood();
    rig_.run(0.01, 0.01);
    for (auto& [place, one] : rig_.members) check(place, one);
  }

  void end() {
    for (auto& [place, one] : rig_.members) one.member.reset();
    rig_.net.tap = nullptr;
    rig_.run(30.0, 0.01);
  }
  [[nodiscard]] const RelayRig& rig() const { return rig_; }

  std::uint64_t delivered = 0, wrong = 0;

 private:
  static RelaySettings makeSettings(int rooms) {
    RelaySettings settings;
    settings.rooms = rooms;
    settings.members = kMembers;
    return settings;
  }

  /// Somebody comes, leaves, is killed or moves to another port.
  void moveOne() {
    const int place = random_.below(rooms_ * kMembers);
    auto& one = rig_.members[place];
    const auto id = static_cast<std::uint16_t>(place % kMembers + 1);
    if (!one.member) {
      rig_.joinAt(addressOf(place), place, id, "room-" + std::to_string(place / kMembers));
      return;
    }
    switch (random_.below(200)) {
      case 0:
        one.member->leave();
        one.member.reset();
        break;
      case 1:
        one.member.reset();
        break;
      case 2:
        ++one.port->address.port;
        break;
      default:
        break;
    }
  }

  void sayAll() {
    for (auto& [place, one] : rig_.members) {
      if (!one.member || random_.below(8) != 0) continue;
      const auto to = static_cast<std::uint16_t>(random_.below(kMembers) + 1);
      rig_.say(one, to, write(place / kMembers, one.id, to));
    }
  }

  /// A flood needs no network to arrive.
  void flood() {
    for (std::uint64_t i = 0; i < forged_ && !overheard_.empty(); ++i) {
      Bytes forged = overheard_;
      forged[static_cast<std::size_t>(random_.below(static_cast<int>(forged.size())))] ^=
          static_cast<std::uint8_t>(1 << random_.below(8));
      rig_.relay->receive({forged.data(), forged.size()}, VirtualNet::addressOf(250), rig_.net.now);
    }
  }

  void check(int place, RelayRig::Member& one) {
    for (const auto& [from, bytes] : one.heard) {
      ++delivered;
      // One bit in a thousand datagrams is turned on the way: between sites the seal finds it.
      Bytes expected = write(place / kMembers, from, one.id);
      int different = 0;
      for (std::size_t i = 0; i < bytes.size() && i < expected.size(); ++i)
        different += bytes[i] != expected[i] ? 1 : 0;
      if (bytes.size() != expected.size() || different > 1) ++wrong;
    }
    one.heard.clear();
  }

  static Address addressOf(int place) {
    Address address = VirtualNet::addressOf(place % 200);
    address.ip[13] = static_cast<std::uint8_t>(1 + place / 200);
    return address;
  }

  int rooms_;
  std::uint64_t forged_ = test::readCount("TANDEM_RELAY_FORGED", 10);
  test::Random random_;
  RelayRig rig_;
  Bytes overheard_;
};

TEST(RelaySoak, NothingGoesToAnotherAndNoPlaceIsLost) {
  constexpr std::uint64_t kSeed = 20261128;
  SCOPED_TRACE(kSeed);
  const auto rooms = static_cast<int>(test::readCount("TANDEM_RELAY_ROOMS", 10));
  const std::uint64_t steps = test::readCount("TANDEM_RELAY_HOURS", 0) * 360'000;
  Crowd crowd(rooms, kSeed);
  const auto* places = &crowd.rig().relay->members();
  for (std::uint64_t i = 0; i < std::max<std::uint64_t>(steps, 6'000); ++i) crowd.step();
  EXPECT_GT(crowd.delivered, 10'000u);
  EXPECT_EQ(crowd.wrong, 0u);
  EXPECT_GT(places->count(), 0u);
  crowd.end();
  EXPECT_EQ(places->count(), 0u);
}

}  // namespace
}  // namespace tandem
