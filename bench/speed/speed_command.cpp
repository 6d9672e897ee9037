#include "bench/speed/speed_command.h"

#include "bench/speed/speed_report.h"
#include "demos/program/plot/gnuplot.h"
#include "demos/program/run/run_output.h"
#include "demos/program/terminal/progress_line.h"
#include "demos/program/terminal/standard_output.h"

namespace tandem::demos::bench {

void runSpeedCommand(const SpeedCommand& command) {
  if (command.folder) {
    prepareFolder(*command.folder);
    plot::requireGnuplot(*command.folder);
  }
  SpeedReport report;
  {
    const ProgressLine line;
    report = measureSpeed(command.quick,
                          [&](std::string_view what, double share) { line.show(what, share); });
  }
  const std::string json = makeSpeedJson(report, command.quick).dump(2) + "\n";
  if (command.folder) {
    plot::writeText(std::filesystem::path(*command.folder) / "speed.json", json);
    plot::drawFigure(makeSpeedFigure(report), *command.folder);
  }
  writeOutput(command.json ? json : makeSpeedTable(report));
}

}  // namespace tandem::demos::bench
