#pragma once

#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace tandem::demos {

/// Rules of an option; by default it is optional and takes any value.
struct OptionRules {
  bool is_required = false;
  std::vector<std::string> choices = {};  ///< allowed values; empty: any
};

/// The arguments of a command. Parsing the command line writes their values into the given
/// variables, which must live until then. Only this class and CommandLine know CLI11.
class Arguments {
 public:
  explicit Arguments(CLI::App& app);
  ~Arguments();
  Arguments(const Arguments&) = delete;
  Arguments& operator=(const Arguments&) = delete;

  void flag(const std::string& name, bool& value, const std::string& help);

  /// Declares an option "--name", or an argument "name" known by its position. `Value` is
  /// std::string, double, int or std::uint64_t, or std::optional of one of them.
  template <class Value>
  void option(const std::string& name, Value& value, const std::string& help,
              const OptionRules& rules = {});

  /// Declares an option that may be given several times, with one value each.
  void repeated(const std::string& name, std::vector<std::string>& values, const std::string& help);
  /// Declares positional arguments, at least one.
  void several(const std::string& name, std::vector<std::string>& values, const std::string& help);
  /// Declares an option with three numbers.
  void triple(const std::string& name, std::vector<double>& values, const std::string& help);

  /// Declares a sub-command with its own arguments.
  Arguments& command(const std::string& name, const std::string& help);
  /// Requires exactly one of the sub-commands; without this call it may be absent.
  void requireCommand();
  /// True if the command line contains this command.
  [[nodiscard]] bool has(const std::string& command) const;

 private:
  CLI::App& app_;
  std::vector<std::unique_ptr<Arguments>> commands_;
};

/// The command line of a program with commands.
class CommandLine {
 public:
  /// `name` is what users type, `summary` the first line of --help.
  CommandLine(const std::string& name, const std::string& summary);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  [[nodiscard]] Arguments& arguments() noexcept { return *arguments_; }

  /// Fills the variables. Prints help and returns false if the user asks for it. Throws UsageError.
  [[nodiscard]] bool parse(int argc, char** argv);

 private:
  [[nodiscard]] std::string describeCommands() const;

  std::unique_ptr<CLI::App> app_;
  std::unique_ptr<Arguments> arguments_;
};

}  // namespace tandem::demos
