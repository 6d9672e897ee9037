// A script of events for two or three sites and their datagrams: deliveries, loss, copies, changes,
// starts, stops, farewells, other addresses, time. See net/membership_script.h.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>

#include <sodium.h>

#include "net/membership_script.h"

namespace {

std::mt19937_64 engine;

void fill(void* bytes, std::size_t size) {
  auto* all = static_cast<std::uint8_t*>(bytes);
  for (std::size_t i = 0; i < size; ++i) all[i] = static_cast<std::uint8_t>(engine());
}

/// Keys and cookies are drawn from a seed, so that equal input gives equal runs.
void drawFromSeed() {
  static randombytes_implementation drawn{};
  drawn.implementation_name = [] { return "seeded"; };
  drawn.random = [] { return static_cast<std::uint32_t>(engine()); };
  drawn.buf = fill;
  randombytes_set_implementation(&drawn);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  drawFromSeed();
  return sodium_init() < 0 ? 1 : 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  engine.seed(2009);
  const std::string broken = tandem::test::playMembershipScript({data, size});
  if (!broken.empty()) {
    std::fprintf(stderr, "membership: %s\n", broken.c_str());
    std::abort();
  }
  return 0;
}
