#include "command/program.h"

int main(int argc, char** argv) {
  using namespace tandem::demos;
  return runProgram(
      {"tandem",
       "Tandem: networked haptic cooperation in Bullet Physics by remote dynamic proxies.",
       listCommands()},
      argc, argv);
}
