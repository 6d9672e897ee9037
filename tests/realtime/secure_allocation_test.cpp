// Sealing, opening and refusing datagrams allocate nothing, nor do cookies.

#include <array>

#include <gtest/gtest.h>

#include "realtime/allocation_count.h"
#include "secure/cookie.h"
#include "secure/seal.h"

namespace tandem {
namespace {

TEST(SecureAllocation, NonePerDatagram) {
  std::array<std::uint8_t, SecretKey::kSize> bytes{}, same{};
  secure::Sealer sealer(SecretKey::take(bytes), 1);
  const secure::Opener opener(SecretKey::take(same), 1);
  const secure::CookieMaker cookies;
  const std::array<std::uint8_t, 20> header{};
  std::array<std::uint8_t, 160 + secure::kTagSize> datagram{};
  int opened = 0, refused = 0, accepted = 0;

  const test::AllocationCount count;
  for (int i = 0; i < 10000; ++i) {
    const std::uint64_t sequence = sealer.nextSequence();
    if (!sealer.seal(header, datagram)) break;
    auto forged = datagram;
    forged[7] ^= 1;
    refused += opener.open(sequence, header, forged) ? 0 : 1;
    opened += opener.open(sequence, header, datagram) ? 1 : 0;
    const secure::CookieSubject subject{1, 2, sequence};
    accepted += cookies.accepts(cookies.make(subject, 1e-3 * i), subject, 1e-3 * i) ? 1 : 0;
  }
  EXPECT_EQ(count.count(), 0U);
  EXPECT_EQ(opened, 10000);
  EXPECT_EQ(refused, 10000);
  EXPECT_EQ(accepted, 10000);
}

}  // namespace
}  // namespace tandem
