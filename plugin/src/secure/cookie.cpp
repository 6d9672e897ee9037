#include "secure/cookie.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <sodium.h>

#include "coordination/src/wire/little_endian.h"

namespace tandem::secure {
namespace {

constexpr std::size_t kTextSize = 8 + 8 + 2 * 2;

}  // namespace

CookieMaker::CookieMaker(SecretKey secret, double slot_length)
    : secret_(std::move(secret)), slot_length_(slot_length) {
  if (!(slot_length > 0.0) || !std::isfinite(slot_length))
    throw std::invalid_argument("slot_length is " + std::to_string(slot_length) +
                                " s, must be finite and above 0");
  if (secret_.isEmpty()) throw std::invalid_argument("the secret of the cookies was moved away");
}

std::int64_t CookieMaker::slotAt(double now) const noexcept {
  // Guards against undefined conversion of extreme times.
  constexpr double kFarAway = 9e18;
  const double slot = std::floor(now / slot_length_);
  return std::abs(slot) < kFarAway ? static_cast<std::int64_t>(slot) : 0;
}

Cookie CookieMaker::makeIn(std::int64_t slot, const CookieSubject& subject) const noexcept {
  std::array<std::uint8_t, kTextSize> text;
  std::uint8_t* end = text.data();
  const auto append = [&end](auto number) {
    wire::storeLittleEndian(number, end);
    end += sizeof number;
  };
  append(static_cast<std::uint64_t>(slot));
  append(subject.nonce);
  append(subject.from);
  append(subject.to);

  Cookie cookie;
  crypto_generichash(cookie.data(), cookie.size(), text.data(), text.size(), secret_.data(),
                     SecretKey::kSize);
  return cookie;
}

Cookie CookieMaker::make(const CookieSubject& subject, double now) const noexcept {
  return makeIn(slotAt(now), subject);
}

bool CookieMaker::accepts(const Cookie& cookie, const CookieSubject& subject,
                          double now) const noexcept {
  const std::int64_t slot = slotAt(now);
  for (const std::int64_t made_in : {slot, slot - 1}) {
    const Cookie right = makeIn(made_in, subject);
    if (sodium_memcmp(cookie.data(), right.data(), right.size()) == 0) return true;
  }
  return false;
}

}  // namespace tandem::secure
