#include "bench/accuracy/accuracy_command.h"

#include <nlohmann/json.hpp>

#include "bench/accuracy/accuracy.h"
#include "bench/accuracy/accuracy_report.h"
#include "demos/program/plot/drawing.h"
#include "demos/program/run/run_output.h"
#include "demos/program/terminal/progress_line.h"
#include "demos/program/terminal/standard_output.h"

namespace tandem::demos::bench {
void runAccuracyCommand(const AccuracyCommand& command) {
  if (command.folder) {
    prepareFolder(*command.folder);
    requireDrawing();
  }
  std::vector<SceneAccuracy> scenes;
  {
    const ProgressLine line;
    scenes = measureAccuracy({command.quick, command.scenes},
                             [&](std::string_view what, double share) { line.show(what, share); });
  }
  const std::string json = makeAccuracyJson(scenes, command.quick).dump(2) + "\n";
  if (command.folder) {
    const auto file = std::filesystem::path(*command.folder) / "accuracy.json";
    writeText(file, json);
    drawBench(file);
  }
  writeOutput(command.json ? json : makeAccuracyTable(scenes));
}

}  // namespace tandem::demos::bench
