// Datagrams for a relay with two members, and for a member. Each is a byte that says how it comes,
// a length and the bytes: as they are, under the relay's key, or under the key of member 1's
// session.

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <vector>

#include "fuzz/seeded_random.h"
#include "relay/relay.h"
#include "relay/relay_member.h"

namespace tandem::relay {
namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

SecretKey makeKey() {
  std::array<std::uint8_t, SecretKey::kSize> bytes{};
  return SecretKey::take(bytes);
}

Address addressOf(int number) {
  Address address;
  address.ip[15] = 1;
  address.port = static_cast<std::uint16_t>(number);
  return address;
}

/// Notes what went to whom.
struct Record final : net::Outlet {
  void send(ByteView datagram, const Address& to) noexcept override {
    last.assign(datagram.data, datagram.data + datagram.size);
    bytes[to.port] += datagram.size;
    forwarded += readType(datagram) == Type::kForwarded ? 1 : 0;
  }
  std::vector<std::uint8_t> last;
  std::map<int, std::size_t> bytes;
  int forwarded = 0;
};

constexpr int kStranger = 3;

/// A relay with members 1 and 2, at the ports 1 and 2.
struct Rig {
  Rig() : relay(makeSettings(), makeKey(), out) {
    for (std::uint16_t id : {std::uint16_t{2}, std::uint16_t{1}}) admit(id);
  }
  static RelaySettings makeSettings() {
    RelaySettings settings;
    settings.rooms = settings.members = 2;
    return settings;
  }

  void admit(std::uint16_t id) {
    Request request{{id, 1}, false, *makeRoomName("r"), {}};
    ask(Type::kHello, request);
    request.cookie = decodeCookieAnswer({out.last.data(), out.last.size()})->cookie;
    ask(Type::kJoin, request);
    session = decodeJoinedAnswer({out.last.data(), out.last.size()})->session;
    key = computeSessionKey(relay_key, request, session);
  }
  void ask(Type type, const Request& request) {
    std::array<std::uint8_t, kHelloSize> bytes{};
    encodeRequest(type, request, {bytes.data(), bytes.size()});
    tagLong(relay_key, {bytes.data(), bytes.size()});
    relay.receive({bytes.data(), bytes.size()}, addressOf(request.caller.member), now);
  }

  void play(std::uint8_t how, std::vector<std::uint8_t> bytes) {
    now += 0.001 * static_cast<double>(how >> 4);
    const ByteSpan all{bytes.data(), bytes.size()};
    const int from = 1 + (how >> 2) % kStranger;
    if (how % 4 == 1 && bytes.size() >= kLongTag) tagLong(relay_key, all);
    if (how % 4 == 2 && bytes.size() >= 8 + kShortTag) {
      wire::storeLittleEndian(session, bytes.data() + 4);
      tagShort(key, all);
    }
    if (how % 4 == 3) {
      (void)member.receive(all, now);
      return;
    }
    const int forwarded = out.forwarded;
    if (from == kStranger) asked += bytes.size();
    relay.receive(all, addressOf(from), now);
    relay.advance(now);
    require(how % 4 == 2 || out.forwarded == forwarded);
    require(relay.members().count() <= 4);
    // Answers, and challenges to a member that seems to be there.
    require(how % 4 == 2 || challenged || out.bytes[kStranger] <= asked);
    challenged = challenged || how % 4 != 0;
  }

  const SecretKey relay_key = makeKey();
  Record out;
  Relay relay;
  std::uint32_t session = 0;  ///< member 1's
  SessionKey key{};
  RelayMember member{addressOf(9), makeKey(), *makeRoomName("r"), PeerId{1}, 1, out};
  double now = 0.0;
  std::size_t asked = 0;
  bool challenged = false;
};

}  // namespace
}  // namespace tandem::relay

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  tandem::fuzz::drawFromSeed();
  return sodium_init() < 0 ? 1 : 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tandem::fuzz::seedAgain();
  tandem::relay::Rig rig;
  while (size >= 2) {
    const std::size_t length = std::min<std::size_t>(data[1], size - 2);
    rig.play(data[0], {data + 2, data + 2 + length});
    data += 2 + length;
    size -= 2 + length;
  }
  return 0;
}
