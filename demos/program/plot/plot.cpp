#include "plot/plot.h"

#include <algorithm>

#include <fmt/format.h>
#include <unistd.h>

#include "tandem/coordination/types.h"

#include "plot/gnuplot.h"
#include "plot/progress.h"
#include "plot/sections.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

namespace fs = std::filesystem;

// Where a report is drawn before it takes its place; removed with everything left in it.
class DraftFolder {
 public:
  explicit DraftFolder(const fs::path& parent)
      : path_(parent / fmt::format(".plot-draft-{}", getpid())) {
    fs::remove_all(path_);
    fs::create_directories(figures());
  }
  ~DraftFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  DraftFolder(const DraftFolder&) = delete;
  DraftFolder& operator=(const DraftFolder&) = delete;

  [[nodiscard]] fs::path figures() const { return path_ / "figures"; }
  [[nodiscard]] fs::path report() const { return path_ / "report.html"; }

 private:
  fs::path path_;
};

// Each folder once, in the order given.
std::vector<plot::Run> loadRuns(const std::vector<fs::path>& run_dirs) {
  if (run_dirs.empty())
    throw UsageError("plot: no run folder given; give folders that `tandem run --out` wrote");
  std::vector<plot::Run> runs;
  std::vector<fs::path> seen;
  for (const fs::path& dir : run_dirs) {
    const fs::path place = fs::weakly_canonical(dir);
    if (std::find(seen.begin(), seen.end(), place) != seen.end()) continue;
    seen.push_back(place);
    runs.push_back(plot::loadRun(dir));
  }
  return runs;
}

void drawFigures(const plot::Report& report, const fs::path& folder) {
  const std::vector<const plot::Figure*> figures = report.figures();
  plot::Progress progress(figures.size());
  for (const plot::Figure* figure : figures) {
    progress.begin(figure->name);
    plot::drawFigure(*figure, folder);
  }
}

bool isPicture(const fs::path& file) {
  return file.extension() == ".svg" || file.extension() == ".png";
}

void publish(const DraftFolder& draft, const fs::path& dir) {
  const fs::path figures = dir / "figures";
  fs::create_directories(figures);
  for (const fs::directory_entry& entry : fs::directory_iterator(figures))
    if (entry.is_regular_file() && isPicture(entry.path())) fs::remove(entry.path());
  for (const fs::directory_entry& entry : fs::directory_iterator(draft.figures()))
    fs::rename(entry.path(), figures / entry.path().filename());
  fs::rename(draft.report(), dir / "report.html");
}

}  // namespace

void plotRuns(const std::vector<fs::path>& run_dirs) {
  const std::vector<plot::Run> runs = loadRuns(run_dirs);
  const plot::Report report = plot::composeReport(runs, plot::groupRuns(runs));
  const fs::path& home = runs.front().dir;
  try {
    const DraftFolder draft(home);
    plot::requireGnuplot(draft.figures());
    fs::remove(draft.figures() / "gnuplot.log");
    drawFigures(report, draft.figures());
    plot::writeText(draft.report(), report.toHtml(draft.figures()));
    publish(draft, home);
  } catch (const fs::filesystem_error& error) {
    throw Error(fmt::format("{}: {}", error.path1().string(), error.code().message()));
  }
  fmt::print("{}\n", (home / "report.html").string());
}

}  // namespace tandem::demos
