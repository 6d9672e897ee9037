#include "tandem/bullet_bridge/bullet_abi.h"

#include <sstream>
#include <string>

#include <dlfcn.h>
#include <link.h>

#include "tandem/coordination/types.h"

namespace tandem {
namespace {

std::string describeScalar(std::size_t bytes) {
  const char* name = bytes == sizeof(double)  ? " (double)"
                     : bytes == sizeof(float) ? " (float)"
                                              : "";
  return std::to_string(bytes) + "-byte" + name;
}

/// The CMake target whose Bullet has scalars of this width.
std::string nameTarget(std::size_t bytes) {
  return bytes == sizeof(double) ? "tandem::plugin_float64" : "tandem::plugin";
}

}  // namespace

std::size_t loadedBulletScalarBytes() noexcept {
  // A btScalar that every libBulletDynamics defines: the symbol table of the one that is loaded
  // says how wide it is.
  void* address = dlsym(RTLD_DEFAULT, "gDeactivationTime");
  if (address == nullptr) return 0;
  Dl_info info{};
  void* entry = nullptr;
  if (dladdr1(address, &info, &entry, RTLD_DL_SYMENT) == 0 || entry == nullptr) return 0;
  return static_cast<std::size_t>(static_cast<const ElfW(Sym)*>(entry)->st_size);
}

void checkBulletAbi(const BulletAbi& host) {
  const BulletAbi library = bulletAbiOfThisCode();
  std::ostringstream message;
  if (host.scalar_bytes != library.scalar_bytes) {
    message << "Bullet scalar width mismatch: the host was compiled for "
            << describeScalar(host.scalar_bytes) << " btScalar, this Tandem library for "
            << describeScalar(library.scalar_bytes) << "; link " << nameTarget(host.scalar_bytes)
            << " instead of " << nameTarget(library.scalar_bytes);
    throw Error(message.str());
  }
  if (host.version != library.version) {
    message << "Bullet version mismatch: the host was compiled against Bullet " << host.version
            << ", this Tandem library against " << library.version
            << "; build both against the same Bullet headers";
    throw Error(message.str());
  }
  const std::size_t loaded = loadedBulletScalarBytes();
  if (loaded != 0 && loaded != library.scalar_bytes) {
    message << "Bullet scalar width mismatch: the Bullet loaded in this process has "
            << describeScalar(loaded) << " btScalar, host and Tandem library were compiled for "
            << describeScalar(library.scalar_bytes)
            << "; load one width of Bullet per process and link " << nameTarget(loaded)
            << " for it";
    throw Error(message.str());
  }
}

}  // namespace tandem
