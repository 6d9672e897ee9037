#include "command/command.h"
#include "view/start_view.h"

namespace tandem::demos {

CommandEntry viewCommand() {
  return {"view", "a live world or a recorded run in a window", 8, nullptr,
          [](char** arguments) { startView("view", arguments); }};
}

}  // namespace tandem::demos
