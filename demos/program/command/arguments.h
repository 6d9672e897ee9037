#pragma once

#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace tandem::demos {

/// What an option may be besides optional and free.
struct OptionRules {
  bool is_required = false;
  std::vector<std::string> choices = {};  ///< the values that are allowed; empty: any
};

/// The arguments that a command takes. Values given on the command line are written into the
/// variables when the program parses it, so these must live until then.
/// Together with CommandLine the only part of the program that knows CLI11.
class Arguments {
 public:
  explicit Arguments(CLI::App& app);
  ~Arguments();
  Arguments(const Arguments&) = delete;
  Arguments& operator=(const Arguments&) = delete;

  void flag(const std::string& name, bool& value, const std::string& help);

  /// `name` is "--name", or "name" for an argument that is known by its position. `Value` is
  /// std::string, double, int or std::uint64_t, or std::optional of one of them.
  template <class Value>
  void option(const std::string& name, Value& value, const std::string& help,
              const OptionRules& rules = {});

  /// An option that may be given several times, with one value each.
  void repeated(const std::string& name, std::vector<std::string>& values, const std::string& help);
  /// Positional arguments, at least one.
  void several(const std::string& name, std::vector<std::string>& values, const std::string& help);
  /// An option with three numbers.
  void triple(const std::string& name, std::vector<double>& values, const std::string& help);

  /// A command of this command, with arguments of its own.
  Arguments& command(const std::string& name, const std::string& help);
  /// One of the commands must be given; without this, none may be.
  void requireCommand();
  /// True if the command line has this command.
  [[nodiscard]] bool has(const std::string& command) const;

 private:
  CLI::App& app_;
  std::vector<std::unique_ptr<Arguments>> commands_;
};

/// The command line of a program that is made of commands.
class CommandLine {
 public:
  /// `name` is what users type, `summary` the first line of --help.
  CommandLine(const std::string& name, const std::string& summary);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  [[nodiscard]] Arguments& arguments() noexcept { return *arguments_; }

  /// Fills the variables. False if help was asked for, which is printed then. Throws UsageError.
  [[nodiscard]] bool parse(int argc, char** argv);

 private:
  [[nodiscard]] std::string describeCommands() const;

  std::unique_ptr<CLI::App> app_;
  std::unique_ptr<Arguments> arguments_;
};

}  // namespace tandem::demos
