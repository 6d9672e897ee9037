// Datagrams to a spectator: first byte even: as they come; odd: the rest is sealed rightly, so that
// what is behind the seal is read. Whatever comes, a state that was taken is within the gate.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <sodium.h>

#include "relay/watched_room.h"
#include "secure/seal.h"

namespace tandem::relay {
namespace {

SecretKey makeWatchKey() {
  std::array<std::uint8_t, SecretKey::kSize> bytes{};
  bytes.fill(0x55);
  return SecretKey::take(bytes);
}

std::vector<std::uint8_t> sealPayload(ByteView payload) {
  const WatchHeader header{1, {7, 9}, 0};
  std::vector<std::uint8_t> datagram(kWatchHeader + payload.size + kWatchTag);
  encodeWatchHeader(header, {datagram.data(), kWatchHeader});
  std::copy_n(payload.data, payload.size, datagram.begin() + kWatchHeader);
  secure::Sealer sealer(makeRunKey(makeWatchKey(), 1, header.run), 0);
  if (!sealer.seal({datagram.data(), kWatchHeader},
                   {datagram.data() + kWatchHeader, payload.size + kWatchTag}))
    std::abort();
  return datagram;
}

void play(bool is_sealed, ByteView bytes) {
  WatchedRoom room(makeWatchKey());
  std::vector<std::uint8_t> datagram(bytes.data, bytes.data + bytes.size);
  if (is_sealed) datagram = sealPayload(bytes);
  const auto result = room.take(1, {datagram.data(), datagram.size()}, 1.0);
  const WatchedSite* site = room.site(PeerId{1});
  if ((result == WatchedRoom::Result::kTaken) != (site != nullptr)) std::abort();
  if (site && !isSane(site->newest)) std::abort();
}

}  // namespace
}  // namespace tandem::relay

extern "C" int LLVMFuzzerInitialize(int*, char***) { return sodium_init() < 0 ? 1 : 0; }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 0) tandem::relay::play((data[0] & 1) != 0, {data + 1, size - 1});
  return 0;
}
