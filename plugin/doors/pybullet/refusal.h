#pragma once

#include <stdexcept>
#include <string>

#include "tandem/tandem.h"

namespace tandem::pybullet {

/// What executePluginCommand() returns when a command was refused; -1 to -7 are TandemResults.
/// PyBullet itself returns -1, with no text, when there is no such plugin.
inline constexpr int kBadCommand = -10;    // not a command, or not its words
inline constexpr int kWrongOrder = -11;    // a command that needs another one before
inline constexpr int kPyBulletSays = -12;  // no such body, or one that cannot take part

/// A command that is not done; `what()` is one line with the value and the remedy.
class Refusal : public std::runtime_error {
 public:
  Refusal(int status, const std::string& text) : std::runtime_error(text), status_(status) {}
  int status() const noexcept { return status_; }

 private:
  int status_;
};

/// Throws what the C door says of a call that failed.
inline void check(TandemResult result) {
  if (result != TANDEM_OK) throw Refusal(-static_cast<int>(result), tandem_last_error());
}

}  // namespace tandem::pybullet
