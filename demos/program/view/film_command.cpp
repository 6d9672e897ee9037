#include "command/command.h"
#include "view/start_view.h"

namespace tandem::demos {

CommandEntry filmCommand() {
  return {"film", "a world or a recorded run as a film", 9, nullptr,
          [](char** arguments) { startView("film", arguments); }};
}

}  // namespace tandem::demos
