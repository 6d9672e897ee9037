#include "import/import_parts.h"

namespace tandem::demos {

void joinOnlyPart(BodyScenario& body) {
  if (body.parts.size() != 1) return;
  const PartScenario only = body.parts[0];
  if (only.position.norm() > 1e-9 || only.rotation.norm() > 1e-9) return;
  body.shape = only.shape;
  body.parts.clear();
}

}  // namespace tandem::demos
