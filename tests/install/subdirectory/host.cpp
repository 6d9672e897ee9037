// Includes all headers of a host, and calls nothing that would need linking.
#include <cstdio>

#include "tandem/plugin/site.h"

int main() {
  const tandem::SiteSettings settings;
  std::printf("%zu-byte btScalar, %.0f ticks a second\n",
              tandem::bulletAbiOfThisCode().scalar_bytes, settings.haptic_rate);
}
