#include "static_bullet.h"

#include <cstring>

#include <link.h>

namespace tandem::preload {
namespace {

// Two halves, so that this library does not contain the whole name.
constexpr char kFirstHalf[] = "23btDiscrete";
constexpr char kSecondHalf[] = "DynamicsWorld";

/// Finds the type name by itself; as part of a symbol name a letter precedes it.
bool hasTypeName(const char* begin, std::size_t size) {
  char name[sizeof kFirstHalf + sizeof kSecondHalf];
  std::strcpy(name, kFirstHalf);
  std::strcat(name, kSecondHalf);
  const std::size_t length = std::strlen(name) + 1;
  const char* const end = begin + size;
  for (const char* at = begin; at < end; ++at) {
    at = static_cast<const char*>(memmem(at, static_cast<std::size_t>(end - at), name, length));
    if (!at) return false;
    const bool is_of_symbol = at > begin && std::strchr("IVST", at[-1]) && at[-1] != '\0';
    if (!is_of_symbol) return true;
  }
  return false;
}

bool isBulletItself(const char* file) {
  const char* slash = std::strrchr(file, '/');
  constexpr const char* kName = "libBulletDynamics";
  return std::strncmp(slash ? slash + 1 : file, kName, std::strlen(kName)) == 0;
}

/// Searches the read-only segments of one loaded object.
int look(dl_phdr_info* info, std::size_t, void* found) {
  if (isBulletItself(info->dlpi_name)) return 0;
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const ElfW(Phdr)& part = info->dlpi_phdr[i];
    const bool is_constant =
        part.p_type == PT_LOAD && (part.p_flags & PF_R) && !(part.p_flags & PF_W);
    if (!is_constant ||
        !hasTypeName(reinterpret_cast<const char*>(info->dlpi_addr + part.p_vaddr), part.p_filesz))
      continue;
    *static_cast<const char**>(found) = info->dlpi_name;
    return 1;
  }
  return 0;
}

}  // namespace

const char* findStaticBullet() noexcept {
  const char* found = nullptr;
  dl_iterate_phdr(look, &found);
  return found;
}

}  // namespace tandem::preload
