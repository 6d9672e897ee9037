#pragma once

#include "command/start_program.h"

namespace tandem::demos {

/// Starts a command of the program that draws. It is apart, so that this one needs no graphics.
[[noreturn]] inline void startView(const char* command, char** arguments) {
  startProgram("tandem-view", {command}, arguments,
               "scripts/packages.sh install view, then build the target tandem-view");
}

}  // namespace tandem::demos
