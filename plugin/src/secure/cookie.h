#pragma once

#include <array>
#include <cstdint>

#include "tandem/plugin/secret_key.h"

namespace tandem::secure {

/// A responder sends it before it stores anything about an initiator. An initiator that returns it
/// is there now: a recording does not know it.
using Cookie = std::array<std::uint8_t, 16>;

/// A question that a cookie answers. Its source address is no part of it: copies of a HELLO from
/// other addresses get the same cookie, so none of them can put a wrong one in its place.
struct CookieSubject {
  std::uint16_t from = 0;  ///< site that sends HELLO
  std::uint16_t to = 0;    ///< site that it calls
  std::uint64_t nonce = 0;
};

/// Makes cookies and recognises its own without storing any.
///
///   cookie = BLAKE2b-128 keyed by a secret of this maker alone, over
///            slot i64 | nonce u64 | from u16 | to u16
///
/// The slot is the number of full `slot_length`s, so the function changes with each slot. A cookie
/// is valid for one to two slots. Pure functions of the given time; real-time safe.
class CookieMaker {
 public:
  static constexpr double kSlotLength = 10.0;  ///< [s]; longer than a handshake with lost datagrams

  /// Throws std::invalid_argument unless `slot_length` [s] is positive and finite.
  explicit CookieMaker(SecretKey secret = SecretKey::generate(), double slot_length = kSlotLength);

  /// Makes the cookie at `now` [s, from any origin].
  [[nodiscard]] Cookie make(const CookieSubject& subject, double now) const noexcept;

  /// True if the cookie was made for this subject in this slot or the previous one.
  [[nodiscard]] bool accepts(const Cookie& cookie, const CookieSubject& subject,
                             double now) const noexcept;

 private:
  [[nodiscard]] std::int64_t slotAt(double now) const noexcept;
  [[nodiscard]] Cookie makeIn(std::int64_t slot, const CookieSubject& subject) const noexcept;

  SecretKey secret_;
  double slot_length_;
};

}  // namespace tandem::secure
