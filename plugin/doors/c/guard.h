#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "tandem/tandem.h"

namespace tandem::c_door {

/// A refusal with a result of its own.
class Refusal final : public std::runtime_error {
 public:
  Refusal(TandemResult result, const std::string& message)
      : std::runtime_error(message), result_(result) {}
  [[nodiscard]] TandemResult result() const noexcept { return result_; }

 private:
  TandemResult result_;
};

/// The result of the exception that is being handled; its text becomes this thread's last error.
TandemResult takeException() noexcept;

/// What every function of the C door does its work in: no exception leaves it.
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
