// Reaches the headers of each library, and calls the one that is compiled for this test.
#include <cstdio>

#include "tandem/coordination/simulated_link.h"
#include "tandem/coordination/types.h"
#include "tandem/plugin/site.h"

int main() {
  const auto [there, back] = tandem::makeSimulatedLinks({});
  std::printf("%s, %zu-byte btScalar\n", there && back ? "two links" : "no link",
              tandem::bulletAbiOfThisCode().scalar_bytes);
}
