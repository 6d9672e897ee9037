#include "bench/accuracy_command.h"

#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/accuracy.h"
#include "bench/accuracy_figure.h"
#include "bench/accuracy_report.h"
#include "bench/progress_line.h"
#include "plot/gnuplot.h"
#include "run_output.h"

namespace tandem::demos::bench {
void runAccuracyCommand(const AccuracyCommand& command) {
  if (command.folder) {
    prepareFolder(*command.folder);
    plot::requireGnuplot(*command.folder);
  }
  std::vector<SceneAccuracy> scenes;
  {
    const ProgressLine line;
    scenes = measureAccuracy({command.quick, command.scenes},
                             [&](std::string_view what, double share) { line.show(what, share); });
  }
  const std::string json = makeAccuracyJson(scenes, command.quick).dump(2) + "\n";
  if (command.folder) {
    plot::writeText(std::filesystem::path(*command.folder) / "accuracy.json", json);
    for (const plot::Figure& figure : makeAccuracyFigures(scenes))
      plot::drawFigure(figure, *command.folder);
  }
  fmt::print("{}", command.json ? json : makeAccuracyTable(scenes));
  if (std::fflush(stdout) != 0)
    throw Error("cannot write to the standard output: is its disk full?");
}

}  // namespace tandem::demos::bench
