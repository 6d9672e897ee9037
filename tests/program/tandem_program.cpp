#include "program/tandem_program.h"

#include <future>

#include "support/checkout.h"

namespace tandem::test {

std::string tandemProgram() { return TANDEM_PROGRAM; }

std::string tandemFloatProgram() { return TANDEM_FLOAT_PROGRAM; }

std::string statesReader() { return TANDEM_STATES_READER; }

Outcome runTandem(const std::vector<std::string>& arguments, const Start& start) {
  return runProgram(tandemProgram(), arguments, start);
}

std::vector<Outcome> runAtOnce(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::future<Outcome>> running;
  for (const auto& line : lines)
    running.push_back(std::async(std::launch::async, [&line] { return runTandem(line); }));
  std::vector<Outcome> outcomes;
  for (auto& one : running) outcomes.push_back(one.get());
  return outcomes;
}

std::string scenarioPath(std::string_view name) {
  return inCheckout("demos/scenarios/" + std::string(name));
}

}  // namespace tandem::test
