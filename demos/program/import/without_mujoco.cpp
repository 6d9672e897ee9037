#include "import/imported_world.h"
#include "terminal/usage_error.h"

namespace tandem::demos {

ImportedWorld importMujoco(const std::filesystem::path& file) {
  throw UsageError(file.string() +
                   ": this program is built without MuJoCo, which reads URDF and MJCF; "
                   "scripts/packages.sh install import, then configure and build again");
}

}  // namespace tandem::demos
