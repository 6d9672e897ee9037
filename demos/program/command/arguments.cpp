#include "command/arguments.h"

#include <cstdint>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "terminal/usage_error.h"

namespace tandem::demos {

Arguments::Arguments(CLI::App& app) : app_(app) {}

Arguments::~Arguments() = default;

void Arguments::flag(const std::string& name, bool& value, const std::string& help) {
  app_.add_flag(name, value, help);
}

template <class Value>
void Arguments::option(const std::string& name, Value& value, const std::string& help,
                       const OptionRules& rules) {
  CLI::Option* option = app_.add_option(name, value, help)->required(rules.is_required);
  if (!rules.choices.empty()) option->check(CLI::IsMember(rules.choices));
}

template void Arguments::option(const std::string&, std::string&, const std::string&,
                                const OptionRules&);
template void Arguments::option(const std::string&, double&, const std::string&,
                                const OptionRules&);
template void Arguments::option(const std::string&, int&, const std::string&, const OptionRules&);
template void Arguments::option(const std::string&, std::uint64_t&, const std::string&,
                                const OptionRules&);
template void Arguments::option(const std::string&, std::optional<std::string>&, const std::string&,
                                const OptionRules&);
template void Arguments::option(const std::string&, std::optional<double>&, const std::string&,
                                const OptionRules&);
template void Arguments::option(const std::string&, std::optional<std::uint64_t>&,
                                const std::string&, const OptionRules&);

void Arguments::repeated(const std::string& name, std::vector<std::string>& values,
                         const std::string& help) {
  app_.add_option(name, values, help)->allow_extra_args(false)->take_all();
}

void Arguments::several(const std::string& name, std::vector<std::string>& values,
                        const std::string& help) {
  app_.add_option(name, values, help)->required();
}

void Arguments::triple(const std::string& name, std::vector<double>& values,
                       const std::string& help) {
  app_.add_option(name, values, help)->expected(3);
}

Arguments& Arguments::command(const std::string& name, const std::string& help) {
  CLI::App* app = app_.add_subcommand(name, help);
  app_.require_subcommand(0, 1);
  return *commands_.emplace_back(std::make_unique<Arguments>(*app));
}

void Arguments::requireCommand() { app_.require_subcommand(1, 1); }

bool Arguments::has(const std::string& command) const { return app_.got_subcommand(command); }

CommandLine::CommandLine(const std::string& name, const std::string& summary)
    : app_(std::make_unique<CLI::App>(summary, name)),
      arguments_(std::make_unique<Arguments>(*app_)) {
  app_->set_version_flag("--version", fmt::format("{} {}", name, TANDEM_VERSION));
}

CommandLine::~CommandLine() = default;

std::string CommandLine::describeCommands() const {
  std::vector<std::string> names;
  for (const CLI::App* command : app_->get_subcommands(nullptr))
    names.push_back(command->get_name());
  return fmt::format("allowed: {}; see {} --help", fmt::join(names, ", "), app_->get_name());
}

bool CommandLine::parse(int argc, char** argv) {
  try {
    app_->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      app_->exit(error);
      return false;
    }
    if (app_->get_subcommands().empty() && !app_->remaining().empty())
      throw UsageError(app_->remaining().front() + ": no such command; " + describeCommands());
    throw UsageError(fmt::format("{}; see {} --help", error.what(), app_->get_name()));
  }
  if (app_->get_subcommands().empty())
    throw UsageError("a command is missing; " + describeCommands());
  return true;
}

}  // namespace tandem::demos
