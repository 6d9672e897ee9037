// What rooms cost on paper (docs/scale.md) is what the simulator counts.
#include "relay/scale.h"

#include <array>
#include <cstdio>

#include <gtest/gtest.h>

#include "relay/relay_rig.h"
#include "support/checkout.h"
#include "support/document.h"

namespace tandem {
namespace {

using test::Bytes;
using test::RelayRig;
using test::RoomsOnPaper;
using test::VirtualNet;

/// Full rooms of one relay, in which each tells each other its state.
class FullRooms {
 public:
  FullRooms(int rooms, int users) : users_(users), rig_(makeSettings(rooms, users)) {
    for (int place = 0; place < rooms * users; ++place)
      rig_.joinAt(addressOf(place), place, static_cast<std::uint16_t>(place % users + 1),
                  "room-" + std::to_string(place / users));
    rig_.run(2.0, 0.01);
    rig_.net.tap = [this](const Bytes& bytes, const Address&, const Address& to) {
      const double size = RoomsOnPaper::kIpAndUdp + static_cast<double>(bytes.size());
      (to == test::relayAddress() ? up : down) += size;
    };
  }

  /// All send `count` states.
  void send(int count, double rate) {
    const Bytes inner(static_cast<std::size_t>(RoomsOnPaper::kInner), 7);
    for (int i = 0; i < count; ++i) {
      for (auto& [place, one] : rig_.members)
        for (int to = 1; to <= users_; ++to)
          if (to != one.id) rig_.say(one, static_cast<std::uint16_t>(to), inner);
      rig_.run(1.0 / rate, 1.0 / rate);
    }
    rig_.run(kDrain, 0.01);
    for (auto& [place, one] : rig_.members) delivered += one.heard.size();
  }

  static constexpr double kDrain = 0.1;  // until the last states are there [s]
  double up = 0.0, down = 0.0;           // [bytes]
  std::uint64_t delivered = 0;

 private:
  static RelaySettings makeSettings(int rooms, int users) {
    RelaySettings settings;
    settings.rooms = rooms;
    settings.members = users;
    return settings;
  }
  static Address addressOf(int place) {
    Address address = VirtualNet::addressOf(place % 200);
    address.ip[13] = static_cast<std::uint8_t>(1 + place / 200);
    return address;
  }

  int users_;
  RelayRig rig_;
};

TEST(Scale, RoomsCostWhatTheyCostOnPaper) {
  constexpr int kStates = 32;
  for (const auto& [rooms, users] : {std::pair{1, 2},
                                     {1, 4},
                                     {1, 8},
                                     {1, 16},
                                     {1, 32},
                                     {1, 64},
                                     {10, 4},
                                     {10, 16},
                                     {100, 4},
                                     {100, 8}}) {
    SCOPED_TRACE(std::to_string(rooms) + " rooms of " + std::to_string(users));
    const RoomsOnPaper paper{static_cast<double>(rooms), static_cast<double>(users)};
    const double seconds = kStates / paper.rate, all = rooms * users;
    FullRooms full(rooms, users);
    full.send(kStates, paper.rate);
    EXPECT_EQ(static_cast<double>(full.delivered), paper.forwarded() * seconds);
    // What keeps a member's place costs it a datagram and an answer a second.
    const double keeps = 200.0 * all;
    EXPECT_NEAR(full.up, all * paper.upOfUser() / 8.0 * seconds, keeps);
    EXPECT_NEAR(full.down, all * paper.downOfUser() / 8.0 * seconds, keeps);
  }
}

constexpr double kPerCore = 250'000.0;  // datagrams that a core of a relay forwards [1/s]
constexpr double kSealing = 4.5e-6;     // of a core, for a state [s]
constexpr double kUsers[] = {2.0, 4.0, 8.0, 16.0, 32.0, 64.0};

std::string print(const char* format, double a, double b = 0.0) {
  char text[64];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

std::string makeRoomTable() {
  std::string table =
      "| users | direct, each way [Mbit/s] | by a relay, up / down [Mbit/s] | of a core, to seal "
      "and "
      "send | forwarded by the relay [1/s] | such rooms on a core of a relay |\n"
      "|---|---|---|---|---|---|\n";
  for (const double users : kUsers) {
    const RoomsOnPaper room{1.0, users};
    table += print("| %.0f ", users) + print("| %.2f ", room.directOfUser() / 1e6) +
             print("| %.2f / %.2f ", room.upOfUser() / 1e6, room.downOfUser() / 1e6) +
             print("| %.2f %% ", 100.0 * room.statesOfUser() * kSealing) +
             print("| %.0f ", room.forwarded()) + print("| %.3g |\n", kPerCore / room.forwarded());
  }
  return table;
}

std::string makeRelayTable() {
  std::string table =
      "| users | 1 room | 10 rooms | 100 rooms | 1,000 rooms | 100,000 rooms |\n"
      "|---|---|---|---|---|---|\n";
  for (const double users : kUsers) {
    table += print("| %.0f |", users);
    const auto show = [](double value) { return print(value < 99.5 ? "%.2g" : "%.0f", value); };
    for (const double rooms : {1.0, 10.0, 100.0, 1e3, 1e5}) {
      const RoomsOnPaper all{rooms, users};
      table += ' ' + show(all.forwarded() / kPerCore) + " / " + show(all.ofRelays() / 1e9) + " |";
    }
    table += "\n";
  }
  return table;
}

TEST(Scale, StandsInTheDocument) {
  const test::Document document(test::inCheckout("docs/scale.md"));
  EXPECT_EQ(document.text(), document.replaceTables(std::array{makeRoomTable(), makeRelayTable()}))
      << "run this test with TANDEM_WRITE_DOCS=1";
}

}  // namespace
}  // namespace tandem
