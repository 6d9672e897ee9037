// Sees all headers of a host; calls nothing that would have to be linked.
#include <cstdio>

#include "tandem/plugin/site.h"

int main() {
  const tandem::SiteSettings settings;
  std::printf("%zu-byte btScalar, %.0f ticks a second\n",
              tandem::bulletAbiOfThisCode().scalar_bytes, settings.haptic_rate);
}
