#include <filesystem>
#include <functional>

#include <fmt/format.h>

#include "command/command.h"
#include "command/picture_size_option.h"
#include "command/user_option.h"
#include "command/world_argument.h"
#include "film/film.h"
#include "import/file_scenario.h"
#include "replay/run_replay.h"
#include "run/scene_record.h"
#include "terminal/status_line.h"
#include "terminal/stop_signals.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

/// `tandem film`: a world or a recorded run as a film, without a display.
class FilmCommand final : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.option(
        "WORLD", world_,
        "a world's name, such as crate, a file as for tandem view, or a folder of a recorded run",
        {.is_required = true});
    arguments.repeated("--set", overrides_, "override a key, as for tandem run");
    arguments.repeated("--share", shares_, "a body of the world's file that both users move");
    arguments.option("--site", site_, "of a recorded run: whose view, 1, 2 ...");
    arguments.option("--out", out_, "film.mp4, .webm, .gif, or a folder for PNG frames",
                     {.is_required = true});
    arguments.option("--size", size_, "width and height in pixels, e.g. 960x600");
    arguments.option("--rate", rate_, "pictures for each second, 1 to 30 (the default)");
    arguments.flag("--quiet", is_quiet_, "print nothing but errors");
  }

  ExitStatus run() override {
    if (!(rate_ >= 1.0 && rate_ <= SceneRecord::kRate))
      throw UsageError(fmt::format("--rate {}: must be from 1 to 30", rate_));
    const view::FilmSettings settings{out_, view::parsePictureSize(size_), rate_};
    {
      ProgressLine line(is_quiet_);
      const StopSignals signals;
      const auto progress = [&](double share) {
        if (signals.isAskedWithin(0.0)) throw Error(out_ + ": stopped; the film is not whole");
        line.show("film", share);
      };
      if (std::filesystem::is_directory(world_)) {
        filmRun(settings, progress);
      } else {
        filmWorld(settings, progress);
      }
    }
    if (!is_quiet_) fmt::print("{}\n", out_);
    return kDone;
  }

 private:
  using Progress = std::function<void(double)>;

  void filmRun(const view::FilmSettings& settings, const Progress& progress) const {
    if (!overrides_.empty() || !shares_.empty())
      throw UsageError("--set: " + world_ +
                       " is a recorded run, whose keys are set; leave --set and --share");
    view::RunReplay replay(view::loadRecordedRun(world_), view::chooseUser(site_));
    view::makeFilm(replay, settings, progress);
  }

  void filmWorld(const view::FilmSettings& settings, const Progress& progress) const {
    if (site_ != 0)
      throw UsageError("--site: chooses the view of a recorded run; leave it for a world");
    view::makeFilm(loadScenario(view::findWorld(world_), addShares(overrides_, shares_)), settings,
                   progress);
  }

  std::vector<std::string> overrides_, shares_;
  int site_ = 0;
  double rate_ = SceneRecord::kRate;
  std::string world_, out_, size_ = "960x600";
  bool is_quiet_ = false;
};

}  // namespace

CommandEntry filmCommand() {
  return {"film", "a world or a recorded run as a film", 2, makeCommand<FilmCommand>};
}

}  // namespace tandem::demos
