#include "bench/speed/speed_command.h"

#include "bench/speed/speed_report.h"
#include "demos/program/plot/drawing.h"
#include "demos/program/run/run_output.h"
#include "demos/program/terminal/progress_line.h"
#include "demos/program/terminal/standard_output.h"

namespace tandem::demos::bench {

void runSpeedCommand(const SpeedCommand& command) {
  if (command.folder) {
    prepareFolder(*command.folder);
    requireDrawing();
  }
  SpeedReport report;
  {
    const ProgressLine line;
    report = measureSpeed(command.quick,
                          [&](std::string_view what, double share) { line.show(what, share); });
  }
  const std::string json = makeSpeedJson(report, command.quick).dump(2) + "\n";
  if (command.folder) {
    const auto file = std::filesystem::path(*command.folder) / "speed.json";
    writeText(file, json);
    drawBench(file);
  }
  writeOutput(command.json ? json : makeSpeedTable(report));
}

}  // namespace tandem::demos::bench
