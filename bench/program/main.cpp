#include "demos/program/command/program.h"

int main(int argc, char** argv) {
  using namespace tandem::demos;
  return runProgram({"tandem bench", "measure on this machine", listCommands()}, argc, argv);
}
