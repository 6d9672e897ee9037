#include <optional>

#include "command/command.h"
#include "files/output_folder.h"
#include "plot/drawing.h"

namespace tandem::demos {
namespace {

/// `tandem plot`: figures and report.html of runs.
class PlotCommand final : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.several("folders", folders_,
                      "folders of runs and analyses; the report goes into the first");
  }

  ExitStatus run() override {
    // A folder that is not there gets the message of one without a run.
    std::optional<OutputLock> lock;
    if (const std::string& home = folders_.front(); std::filesystem::is_directory(home))
      lock.emplace(std::filesystem::path(home) / kFolderLock, home);
    return static_cast<ExitStatus>(plotRuns(folders_));
  }

 private:
  std::vector<std::string> folders_;
};

}  // namespace

CommandEntry plotCommand() {
  return {"plot", "figures and report.html of one run, or of several compared", 2,
          makeCommand<PlotCommand>};
}

}  // namespace tandem::demos
