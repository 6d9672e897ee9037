#include <charconv>
#include <cstdio>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tandem/coordination/types.h"

#include "command/command.h"
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

/// Options of `tandem link`, as written.
struct LinkOptions {
  std::string listen, forward;
  std::string delay = "0s", jitter = "0s";
  std::string loss = "0%", duplicate = "0%", reorder = "0%", corrupt = "0%";
  bool keep_order = false;
  std::string seed = "0";
  std::optional<std::string> script;    ///< file
  std::optional<std::string> duration;  ///< empty: until SIGINT or SIGTERM
  bool json = false;
  bool quiet = false;
};

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

double readDuration(const LinkOptions& options) {
  if (!options.duration) return std::numeric_limits<double>::infinity();
  const auto duration = parseSeconds(*options.duration);
  if (!duration || *duration > kLongestRun)
    throw UsageError(
        fmt::format("--for {}: must be seconds from 0 to 1e6, such as 10", *options.duration));
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

LinkProxySettings readSettings(const LinkOptions& options) {
  LinkProxySettings settings;
  Impairments& impairments = settings.start.impairments;
  impairments.delay = read("--delay", options.delay, parseDelay, kAllowedDelay);
  impairments.jitter = read("--jitter", options.jitter, parseDelay, kAllowedDelay);
  impairments.loss = read("--loss", options.loss, parseShare, kAllowedShare);
  impairments.duplicate = read("--duplicate", options.duplicate, parseShare, kAllowedShare);
  impairments.reorder = read("--reorder", options.reorder, parseShare, kAllowedShare);
  impairments.seed = readSeed(options.seed);
  settings.start.corrupt = read("--corrupt", options.corrupt, parseShare, kAllowedShare);
  settings.start.keep_order = options.keep_order;
  if (options.script) settings.changes = loadLinkScript(*options.script);
  settings.listen = readAddress("--listen", options.listen);
  settings.forward = readAddress("--forward", options.forward);
  return settings;
}

void runLink(const LinkOptions& options) {
  const double duration = readDuration(options);
  LinkProxy proxy(readSettings(options));
  const StopSignals stop;
  if (!options.quiet) {
    fmt::print(options.json ? stderr : stdout, "listening on {}\n", toString(proxy.bound()));
    finishOutput();  // other programs wait for this line
  }
  proxy.run(stop, duration);
  const nlohmann::json report = makeLinkReport(proxy);
  if (options.json) {
    writeOutput(report.dump(2) + "\n");
  } else if (!options.quiet) {
    writeOutput(formatLinkReport(report));
  }
}

/// `tandem link`: runs to its end and prints asked against achieved.
class LinkCommand final : public Command {
 public:
  void declare(Arguments& arguments) override {
    LinkOptions& own = options_;
    arguments.option("--listen", own.listen, "the client sends here; host:port or :port",
                     {.is_required = true});
    arguments.option("--forward", own.forward, "the server, host:port", {.is_required = true});
    arguments.option("--delay", own.delay, "one way, such as 50ms");
    arguments.option("--jitter", own.jitter, "the delay is even in delay +- jitter");
    arguments.option("--loss", own.loss, "so many never arrive, such as 2%");
    arguments.option("--duplicate", own.duplicate, "so many arrive twice");
    arguments.option("--reorder", own.reorder, "so many jump the queue, without delay");
    arguments.option("--corrupt", own.corrupt, "in so many one bit is turned");
    arguments.flag("--keep-order", own.keep_order, "jitter lets none overtake another");
    arguments.option("--seed", own.seed, "another seed, other fates");
    arguments.option("--script", own.script, "changes over time (TOML)");
    arguments.option("--for", own.duration, "end after so many seconds");
    arguments.flag("--json", own.json, "print the report as JSON to stdout");
    arguments.flag("--quiet", own.quiet, "print nothing but errors");
  }

  ExitStatus run() override {
    runLink(options_);
    return kDone;
  }

 private:
  LinkOptions options_;
};

}  // namespace

CommandEntry linkCommand() {
  return {"link", "a bad network between two programs, by UDP", 5, makeCommand<LinkCommand>};
}

}  // namespace tandem::demos
