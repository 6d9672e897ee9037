#include "tandem/bullet_bridge/bullet_abi.h"

#include <sstream>
#include <string>
#include <vector>

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

/// A btScalar that every libBulletDynamics defines; its size in the symbol table is the scalar
/// width.
constexpr const char* kScalarOfBullet = "gDeactivationTime";

struct FoundScalar {
  std::size_t bytes = 0;     ///< 0: not found
  const char* library = "";  ///< file that defines it; valid while it is loaded
};

FoundScalar findScalar(void* handle) noexcept {
  void* address = dlsym(handle, kScalarOfBullet);
  Dl_info info{};
  void* entry = nullptr;
  if (address == nullptr) return {};
  if (dladdr1(address, &info, &entry, RTLD_DL_SYMENT) == 0 || entry == nullptr) return {};
  return {static_cast<std::size_t>(static_cast<const ElfW(Sym)*>(entry)->st_size), info.dli_fname};
}

/// Names of all shared objects of this process.
std::vector<std::string> listLoadedLibraries() {
  std::vector<std::string> names;
  // Only collected here: the linker is locked during the walk.
  dl_iterate_phdr(
      [](dl_phdr_info* object, std::size_t, void* list) {
        static_cast<std::vector<std::string>*>(list)->emplace_back(object->dlpi_name);
        return 0;
      },
      &names);
  return names;
}

}  // namespace

std::size_t loadedBulletScalarBytes() noexcept { return findScalar(RTLD_DEFAULT).bytes; }

std::string findOtherBulletWidth(std::size_t scalar_bytes) {
  for (const std::string& name : listLoadedLibraries()) {
    if (name.empty()) continue;  // the program itself
    void* library = dlopen(name.c_str(), RTLD_LAZY | RTLD_NOLOAD);
    if (library == nullptr) continue;
    const FoundScalar found = findScalar(library);
    const bool is_other = found.bytes != 0 && found.bytes != scalar_bytes;
    std::string file = is_other ? found.library : "";
    dlclose(library);
    if (is_other) return file;
  }
  return {};
}

void checkBulletAbi(const BulletAbi& host) {
  const BulletAbi library = bulletAbiOfThisCode();
  std::ostringstream message;
  if (host.scalar_bytes != library.scalar_bytes) {
    message << "Bullet scalar width mismatch: the host was compiled for "
            << describeScalar(host.scalar_bytes) << " btScalar, this Tandem library for "
            << describeScalar(library.scalar_bytes) << "; link " << nameTarget(host.scalar_bytes)
            << " instead of " << nameTarget(library.scalar_bytes);
    throw WrongBulletError(message.str());
  }
  if (host.version != library.version) {
    message << "Bullet version mismatch: the host was compiled against Bullet " << host.version
            << ", this Tandem library against " << library.version
            << "; build both against the same Bullet headers";
    throw WrongBulletError(message.str());
  }
  const std::size_t loaded = loadedBulletScalarBytes();
  if (loaded != 0 && loaded != library.scalar_bytes) {
    message << "Bullet scalar width mismatch: the Bullet loaded in this process has "
            << describeScalar(loaded) << " btScalar, host and Tandem library were compiled for "
            << describeScalar(library.scalar_bytes)
            << "; load one width of Bullet per process and link " << nameTarget(loaded)
            << " for it";
    throw WrongBulletError(message.str());
  }
  if (const std::string other = findOtherBulletWidth(library.scalar_bytes); !other.empty()) {
    const std::size_t bytes =
        library.scalar_bytes == sizeof(double) ? sizeof(float) : sizeof(double);
    message << "Bullet scalar width mismatch: this Tandem library ("
            << nameTarget(library.scalar_bytes) << ") is for "
            << describeScalar(library.scalar_bytes) << " btScalar, and " << other
            << " has brought Bullet with " << describeScalar(bytes) << " btScalar ("
            << nameTarget(bytes)
            << ") into the same process, where they share constants; load one width per process";
    throw WrongBulletError(message.str());
  }
}

}  // namespace tandem
