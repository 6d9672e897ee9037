#include "command/program.h"

int main(int argc, char** argv) {
  using namespace tandem::demos;
  return runProgram({"tandem-view", "Tandem in pictures: a window and films.", listCommands()},
                    argc, argv);
}
