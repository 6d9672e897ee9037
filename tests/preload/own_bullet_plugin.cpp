// A plugin for two_widths_host with its own Bullet inside, not Debian's.

#include <cstdio>
#include <memory>

#include "preload/own_bullet.h"

extern "C" [[gnu::visibility("default")]] int runHost(int, char**) {
  const auto world = std::make_unique<btDiscreteDynamicsWorld>(nullptr, nullptr, nullptr, nullptr);
  for (int i = 0; i < 3; ++i) world->stepSimulation(0.1, 1, 0.1);
  std::printf("%d steps\n", world->steps);
  return 0;
}
