#pragma once

#include <sodium.h>

namespace tandem::net {

/// Random number other than 0.
template <typename Unsigned>
[[nodiscard]] Unsigned drawNumber() noexcept {
  Unsigned number = 0;
  while (number == 0) randombytes_buf(&number, sizeof number);
  return number;
}

}  // namespace tandem::net
