// A host whose plugins bring a Bullet each, of different widths, and export it to no other library.
// The plugins are host.cpp twice. Prints the output of each.
//
//   two_widths_host PLUGIN... -- ARGUMENTS OF EACH

#include <cstdio>
#include <cstring>

#include <dlfcn.h>

int main(int argc, char** argv) {
  int files = 1;
  while (files < argc && std::strcmp(argv[files], "--") != 0) ++files;
  for (int i = 1; i < files; ++i) {
    void* plugin = dlopen(argv[i], RTLD_NOW | RTLD_LOCAL);
    auto run = plugin ? reinterpret_cast<int (*)(int, char**)>(dlsym(plugin, "runHost")) : nullptr;
    if (!run || run(argc - files, argv + files) != 0) {
      std::fprintf(stderr, "two_widths_host: %s\n", dlerror());
      return 1;
    }
  }
  return 0;
}
