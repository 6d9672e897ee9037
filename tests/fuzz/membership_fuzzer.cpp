// A script of events for two or three sites and their datagrams: deliveries, loss, copies, changes,
// starts, stops, farewells, other addresses, time. See net/membership_script.h.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "fuzz/seeded_random.h"
#include "net/membership_script.h"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  tandem::fuzz::drawFromSeed();
  return sodium_init() < 0 ? 1 : 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tandem::fuzz::seedAgain();
  const std::string broken = tandem::test::playMembershipScript({data, size});
  if (!broken.empty()) {
    std::fprintf(stderr, "membership: %s\n", broken.c_str());
    std::abort();
  }
  return 0;
}
