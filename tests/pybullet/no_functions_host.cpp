// A program that loads the plugin and lacks all functions that it needs. Exits with 0 if the plugin
// reports this and does not load.

#include <cstdio>

#include <dlfcn.h>

#include "plugin/doors/pybullet/b3_abi.h"

int main() {
  void* const module = dlopen(TANDEM_PYBULLET_PLUGIN, RTLD_NOW | RTLD_LOCAL);
  if (!module) {
    std::printf("%s\n", dlerror());
    return 1;
  }
  using Init = int (*)(tandem::pybullet::b3::PluginContext*);
  const auto init = reinterpret_cast<Init>(dlsym(module, "initPlugin_tandem"));
  tandem::pybullet::b3::PluginContext context{};
  const int magic = init(&context);
  dlclose(module);
  return magic == 0 && context.user_pointer == nullptr ? 0 : 1;
}
