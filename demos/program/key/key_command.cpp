#include <fmt/format.h>

#include "tandem/plugin/key_file.h"

#include "command/command.h"
#include "terminal/standard_output.h"

namespace tandem::demos {
namespace {

/// `tandem key new`: a key that two sites share.
class KeyCommand final : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.command("new", "write a new random key into a file of your own")
        .option("file", path_, "a name that is not there yet", {.is_required = true});
    arguments.requireCommand();
  }

  ExitStatus run() override {
    makeKeyFile(path_);
    fmt::print("{}: a new key; copy it to the other site by a way that nobody reads along\n",
               path_);
    finishOutput();
    return kDone;
  }

 private:
  std::string path_;
};

}  // namespace

CommandEntry keyCommand() {
  return {"key", "keys that two sites share", 7, makeCommand<KeyCommand>};
}

}  // namespace tandem::demos
