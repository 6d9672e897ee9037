#pragma once

#include <array>
#include <cstdint>

#include "tandem/plugin/secret_key.h"

#include "secure/bytes.h"

namespace tandem::secure {

/// What a responder sends back before it keeps anything of an initiator: who returns it can receive
/// at the address that it sends from.
using Cookie = std::array<std::uint8_t, 16>;

/// Who asks. The address is as the socket gives it, up to 16 bytes (IPv6).
struct CookieSubject {
  ByteView address;
  std::uint16_t port = 0;
  std::uint16_t from = 0;  ///< site that says hello
  std::uint16_t to = 0;    ///< site that it wants
  std::uint64_t nonce = 0;
};

/// Makes cookies and knows its own again without remembering any.
///
///   cookie = BLAKE2b-128 keyed by a secret of this maker alone, over
///            slot i64 | nonce u64 | port u16 | from u16 | to u16 | address size u8 | address
///
/// The slot is the number of `slot_length`s that have passed, so the function is a new one in each,
/// and a cookie holds for one to two of them. Pure functions of the time given; real-time safe.
class CookieMaker {
 public:
  static constexpr double kSlotLength = 10.0;  ///< [s]; longer than a handshake with lost datagrams

  /// Throws std::invalid_argument unless the length is positive and finite [s].
  explicit CookieMaker(SecretKey secret = SecretKey::generate(), double slot_length = kSlotLength);

  /// The cookie at `now` [s, from any origin]; nothing else tells it. An address longer than 16
  /// bytes counts by its first 16.
  [[nodiscard]] Cookie make(const CookieSubject& subject, double now) const noexcept;

  /// Whether this cookie was made for the same subject in this slot or the one before.
  [[nodiscard]] bool accepts(const Cookie& cookie, const CookieSubject& subject,
                             double now) const noexcept;

 private:
  [[nodiscard]] std::int64_t slotAt(double now) const noexcept;
  [[nodiscard]] Cookie makeIn(std::int64_t slot, const CookieSubject& subject) const noexcept;

  SecretKey secret_;
  double slot_length_;
};

}  // namespace tandem::secure
