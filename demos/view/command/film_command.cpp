#include <fmt/format.h>

#include "command/command.h"
#include "command/picture_size_option.h"
#include "command/world_argument.h"
#include "film/film.h"
#include "terminal/status_line.h"
#include "terminal/stop_signals.h"

namespace tandem::demos {
namespace {

/// `tandem film`: a world as a film, without a display.
class FilmCommand final : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.option("WORLD", world_, "a world's name, such as crate, or a scenario file",
                     {.is_required = true});
    arguments.repeated("--set", settings_.overrides, "override a key, as for tandem run");
    arguments.option("--out", out_, "film.mp4, .webm, .gif, or a folder for PNG frames",
                     {.is_required = true});
    arguments.option("--size", size_, "width and height in pixels, e.g. 960x600");
    arguments.flag("--quiet", is_quiet_, "print nothing but errors");
  }

  ExitStatus run() override {
    settings_.scenario = view::findWorld(world_);
    settings_.out = out_;
    settings_.size = view::parsePictureSize(size_);
    ProgressLine progress(is_quiet_);
    const StopSignals signals;
    view::makeFilm(settings_, [&](double share) {
      if (signals.isAskedWithin(0.0)) throw Error(out_ + ": stopped; the film is not whole");
      progress.show("film", share);
    });
    if (!is_quiet_) fmt::print("{}\n", out_);
    return kDone;
  }

 private:
  view::FilmSettings settings_;
  std::string world_, out_, size_ = "960x600";
  bool is_quiet_ = false;
};

}  // namespace

CommandEntry filmCommand() { return {"film", "a world as a film", 2, makeCommand<FilmCommand>}; }

}  // namespace tandem::demos
