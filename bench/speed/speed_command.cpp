#include <nlohmann/json.hpp>

#include "bench/program/result_output.h"
#include "bench/speed/speed_report.h"
#include "demos/program/command/command.h"
#include "demos/program/terminal/status_line.h"

namespace tandem::demos {
namespace {

/// `tandem bench speed`: run time against the size of the world.
class SpeedCommand final : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.flag("--json", output_.json, "print speed.json to stdout");
    arguments.flag("--quick", quick_, "fewer worlds, shorter and fewer repeats");
    arguments.option("--out", output_.folder, "folder for speed.json, speed.svg, speed.png");
  }

  ExitStatus run() override {
    output_.open();
    const bench::SpeedReport report = measure();
    output_.write("speed", bench::makeSpeedJson(report, quick_).dump(2) + "\n",
                  bench::makeSpeedTable(report));
    return kDone;
  }

 private:
  bench::SpeedReport measure() const {
    ProgressLine line;
    return bench::measureSpeed(
        quick_, [&](std::string_view what, double share) { line.show(what, share); });
  }

  bool quick_ = false;
  bench::ResultOutput output_;
};

}  // namespace

CommandEntry speedCommand() {
  return {"speed", "run time against bodies of the host and shared objects, and what it should be",
          2, makeCommand<SpeedCommand>};
}

}  // namespace tandem::demos
