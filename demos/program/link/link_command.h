#pragma once

#include <optional>
#include <string>

namespace tandem::demos {

/// Options of `tandem link`, as they were written.
struct LinkCommand {
  std::string listen, forward;
  std::string delay = "0s", jitter = "0s";
  std::string loss = "0%", duplicate = "0%", reorder = "0%", corrupt = "0%";
  bool keep_order = false;
  std::string seed = "0";
  std::optional<std::string> script;    ///< file
  std::optional<std::string> duration;  ///< nothing: until SIGINT or SIGTERM
  bool json = false;
  bool quiet = false;
};

/// Runs to its end and prints asked against achieved. Throws UsageError, std::invalid_argument or
/// tandem::Error, one line.
void runLinkCommand(const LinkCommand& command);

}  // namespace tandem::demos
