#include "relay/watch_wire.h"

#include <string_view>

#include "coordination/src/wire/byte_reader.h"
#include "coordination/src/wire/byte_writer.h"
#include "coordination/src/wire/wire_sealing.h"
#include "relay/wire_start.h"
#include "secure/bytes.h"

namespace tandem::relay {
namespace {

constexpr std::uint16_t kWatchMagic = 0x7754;  ///< "Tw": no datagram between two sites
constexpr std::uint8_t kWatchVersion = 1;
constexpr std::uint8_t kStateType = 1;
constexpr std::uint32_t kWatchSalt = 0;  ///< each run has a key of its own

}  // namespace

void encodeWatchHeader(const WatchHeader& header, ByteSpan out) noexcept {
  wire::ByteWriter writer(out);
  writer.write(kWatchMagic);
  writer.write(kWatchVersion);
  writer.write(kStateType);
  writer.write(header.sender);
  writer.write(std::uint16_t{0});
  writer.write(header.run.begun);
  writer.write(header.run.random);
  writer.write(header.sequence);
}

std::optional<WatchHeader> decodeWatchHeader(ByteView datagram) noexcept {
  constexpr std::size_t kLeast = kWatchHeader + kStateBlockSize + kWatchTag;
  if (datagram.size < kLeast || datagram.size > kMaxWatch) return std::nullopt;
  wire::ByteReader reader(datagram);
  const bool is_watch = reader.read<std::uint16_t>() == kWatchMagic &&
                        reader.read<std::uint8_t>() == kWatchVersion &&
                        reader.read<std::uint8_t>() == kStateType;
  WatchHeader header;
  header.sender = reader.read<std::uint16_t>();
  if (!is_watch || !isMember(header.sender) || reader.read<std::uint16_t>() != 0)
    return std::nullopt;
  header.run.begun = reader.read<std::uint64_t>();
  header.run.random = reader.read<std::uint64_t>();
  header.sequence = reader.read<std::uint64_t>();
  return header;
}

void deriveRunKey(const SecretKey& watch_key, std::uint16_t sender, const WatchRun& run,
                  std::uint8_t* out) noexcept {
  constexpr std::string_view kLabel = "tandem watch";
  std::array<std::uint8_t, kLabel.size() + 18> text;
  wire::ByteWriter writer({text.data(), text.size()});
  writer.writeBytes(kLabel);
  writer.write(sender);
  writer.write(run.begun);
  writer.write(run.random);
  crypto_generichash(out, SecretKey::kSize, text.data(), text.size(), watch_key.data(),
                     SecretKey::kSize);
}

SecretKey makeRunKey(const SecretKey& watch_key, std::uint16_t sender, const WatchRun& run) {
  secure::WipedBytes<SecretKey::kSize> bytes;
  deriveRunKey(watch_key, sender, run, bytes.data());
  return SecretKey::take(bytes);
}

std::optional<ByteView> openWatch(const SecretKey& watch_key, const WatchHeader& header,
                                  ByteSpan datagram) noexcept {
  secure::WipedBytes<SecretKey::kSize> key;
  deriveRunKey(watch_key, header.sender, header.run, key.data());
  std::uint8_t* const payload = datagram.data + kWatchHeader;
  const std::size_t size = datagram.size - kWatchHeader - kWatchTag;
  const bool is_open =
      crypto_aead_chacha20poly1305_ietf_decrypt_detached(
          payload, nullptr, payload, size, payload + size, datagram.data, kWatchHeader,
          writeNonce(kWatchSalt, header.sequence).data(), key.data()) == 0;
  return is_open ? std::optional(ByteView{payload, size}) : std::nullopt;
}

}  // namespace tandem::relay
