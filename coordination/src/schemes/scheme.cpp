#include "tandem/coordination/scheme.h"

#include <stdexcept>

namespace tandem {

const Scheme& findScheme(std::string_view name) {
  std::string known;
  for (const Scheme* scheme : allSchemes()) {
    if (scheme->name() == name) return *scheme;
    known += (known.empty() ? "" : ", ") + std::string(scheme->name());
  }
  throw std::invalid_argument("there is no scheme '" + std::string(name) + "'; allowed: " + known);
}

}  // namespace tandem
