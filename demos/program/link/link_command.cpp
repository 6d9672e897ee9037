#include "link/link_command.h"

#include <charconv>
#include <cstdio>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tandem/coordination/types.h"

#include "link/link_proxy.h"
#include "link/link_report.h"
#include "link/link_script.h"
#include "link/units.h"
#include "terminal/standard_output.h"
#include "terminal/stop_signals.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

constexpr double kLongestRun = 1e6;  // [s]

using Parse = std::optional<double> (*)(std::string_view) noexcept;

double read(const char* option, const std::string& text, Parse parse, const char* allowed) {
  if (const auto value = parse(text)) return *value;
  throw UsageError(fmt::format("{} {}: must be {}", option, text, allowed));
}

Address readAddress(const char* option, const std::string& text) {
  try {
    return resolveAddress(text);
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("{} {}: {}", option, text, error.what()));
  }
}

double readDuration(const LinkCommand& command) {
  if (!command.duration) return std::numeric_limits<double>::infinity();
  const auto duration = parseSeconds(*command.duration);
  if (!duration || *duration > kLongestRun)
    throw UsageError(
        fmt::format("--for {}: must be seconds from 0 to 1e6, such as 10", *command.duration));
  return *duration;
}

std::uint64_t readSeed(const std::string& text) {
  std::uint64_t seed = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, seed);
  if (error != std::errc() || rest != end)
    throw UsageError(fmt::format("--seed {}: must be a whole number from 0 to 2^64 - 1", text));
  return seed;
}

LinkProxySettings readSettings(const LinkCommand& command) {
  LinkProxySettings settings;
  Impairments& impairments = settings.start.impairments;
  impairments.delay = read("--delay", command.delay, parseDelay, kAllowedDelay);
  impairments.jitter = read("--jitter", command.jitter, parseDelay, kAllowedDelay);
  impairments.loss = read("--loss", command.loss, parseShare, kAllowedShare);
  impairments.duplicate = read("--duplicate", command.duplicate, parseShare, kAllowedShare);
  impairments.reorder = read("--reorder", command.reorder, parseShare, kAllowedShare);
  impairments.seed = readSeed(command.seed);
  settings.start.corrupt = read("--corrupt", command.corrupt, parseShare, kAllowedShare);
  settings.start.keep_order = command.keep_order;
  if (command.script) settings.changes = loadLinkScript(*command.script);
  settings.listen = readAddress("--listen", command.listen);
  settings.forward = readAddress("--forward", command.forward);
  return settings;
}

}  // namespace

void runLinkCommand(const LinkCommand& command) {
  const double duration = readDuration(command);
  LinkProxy proxy(readSettings(command));
  const StopSignals stop;
  if (!command.quiet) {
    fmt::print(command.json ? stderr : stdout, "listening on {}\n", toString(proxy.bound()));
    finishOutput();  // programs wait for this line
  }
  proxy.run(stop, duration);
  const nlohmann::json report = makeLinkReport(proxy);
  if (command.json) {
    writeOutput(report.dump(2) + "\n");
  } else if (!command.quiet) {
    writeOutput(formatLinkReport(report));
  }
}

}  // namespace tandem::demos
