#include "import/imported_world.h"
#include "terminal/usage_error.h"

namespace tandem::demos {

ImportedWorld importBullet(const std::filesystem::path& file, double) {
  throw UsageError(file.string() +
                   ": this program is built without Bullet's reader of its files; "
                   "scripts/packages.sh install import, then configure and build again");
}

}  // namespace tandem::demos
