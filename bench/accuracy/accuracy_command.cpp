#include <nlohmann/json.hpp>

#include "bench/accuracy/accuracy.h"
#include "bench/accuracy/accuracy_report.h"
#include "bench/program/result_output.h"
#include "demos/program/command/command.h"
#include "demos/program/terminal/status_line.h"

namespace tandem::demos {
namespace {

/// `tandem bench accuracy`: run time against error.
class AccuracyCommand final : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.flag("--json", output_.json, "print accuracy.json to stdout");
    arguments.flag("--quick", quick_, "fewer host rates and repeats, coarser references");
    arguments.repeated("--scene", scenes_, "only this scene; may be given several times");
    arguments.option("--out", output_.folder,
                     "folder for accuracy.json, accuracy.svg, accuracy.png");
  }

  ExitStatus run() override {
    output_.open();
    const std::vector<bench::SceneAccuracy> scenes = measure();
    output_.write("accuracy", bench::makeAccuracyJson(scenes, quick_).dump(2) + "\n",
                  bench::makeAccuracyTable(scenes));
    return kDone;
  }

 private:
  std::vector<bench::SceneAccuracy> measure() const {
    ProgressLine line;
    return bench::measureAccuracy(
        {quick_, scenes_}, [&](std::string_view what, double share) { line.show(what, share); });
  }

  bool quick_ = false;
  std::vector<std::string> scenes_;  // names; empty: all
  bench::ResultOutput output_;
};

}  // namespace

CommandEntry accuracyCommand() {
  return {"accuracy", "run time against error of the plugin and of other ways to simulate", 1,
          makeCommand<AccuracyCommand>};
}

}  // namespace tandem::demos
