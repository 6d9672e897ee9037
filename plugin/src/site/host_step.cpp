#include "site/host_step.h"

#include "site/hand_off_step.h"
#include "site/impulse_step.h"
#include "site/native_step.h"

namespace tandem {

std::unique_ptr<HostStep> makeHostStep(SiteParts& parts) {
  if (parts.settings.contact_model != ContactModel::kIsland)
    return std::make_unique<NativeStep>(parts);
  if (parts.settings.injection == Injection::kHandoff) return std::make_unique<HandOffStep>(parts);
  return std::make_unique<ImpulseStep>(parts);
}

}  // namespace tandem
