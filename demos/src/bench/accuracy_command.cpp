#include "bench/accuracy_command.h"

#include <nlohmann/json.hpp>

#include "bench/accuracy.h"
#include "bench/accuracy_figure.h"
#include "bench/accuracy_report.h"
#include "bench/progress_line.h"
#include "plot/gnuplot.h"
#include "run_output.h"
#include "standard_output.h"

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
  writeOutput(command.json ? json : makeAccuracyTable(scenes));
}

}  // namespace tandem::demos::bench
