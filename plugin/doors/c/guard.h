#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "tandem/tandem.h"

namespace tandem::c_door {

/// An error with its own TandemResult.
class Refusal final : public std::runtime_error {
 public:
  Refusal(TandemResult result, const std::string& message)
      : std::runtime_error(message), result_(result) {}
  [[nodiscard]] TandemResult result() const noexcept { return result_; }

 private:
  TandemResult result_;
};

/// Result of the exception being handled; its text becomes this thread's last error.
TandemResult takeException() noexcept;

/// Runs the work of a C function; no exception leaves it.
template <typename Work>
TandemResult guarded(Work&& work) noexcept {
  try {
    std::forward<Work>(work)();
    return TANDEM_OK;
  } catch (...) {
    return takeException();
  }
}

}  // namespace tandem::c_door
