// A program without Bullet. It loads modules that each bring their own Bullet, and lets each attach
// a site. usage: no_width MODULE...
#include <cstdio>

#include <dlfcn.h>

int main(int count, char** modules) {
  for (int i = 1; i < count; ++i) {
    void* const loaded = dlopen(modules[i], RTLD_NOW | RTLD_LOCAL);
    if (loaded == nullptr) {
      std::printf("%s\n", dlerror());
      return 1;
    }
    using Attach = void (*)(char*, int);
    char answer[1000] = "";
    reinterpret_cast<Attach>(dlsym(loaded, "attachSite"))(answer, sizeof answer);
    std::printf("%s\n", answer);
  }
}
