#pragma once

#include <stdexcept>
#include <string>

#include "tandem/tandem.h"

namespace tandem::pybullet {

/// Results of executePluginCommand() for a refused command; -1 to -7 are TandemResults. PyBullet
/// itself returns -1 without a text if the plugin is missing.
inline constexpr int kBadCommand = -10;    // unknown command, or wrong words
inline constexpr int kWrongOrder = -11;    // the command needs another one before
inline constexpr int kPyBulletSays = -12;  // no such body, or an unsuitable one

/// Error of a command; `what()` is one line with the value and the remedy.
class Refusal : public std::runtime_error {
 public:
  Refusal(int status, const std::string& text) : std::runtime_error(text), status_(status) {}
  int status() const noexcept { return status_; }

 private:
  int status_;
};

/// Throws the C interface's error if a call failed.
inline void check(TandemResult result) {
  if (result != TANDEM_OK) throw Refusal(-static_cast<int>(result), tandem_last_error());
}

}  // namespace tandem::pybullet
