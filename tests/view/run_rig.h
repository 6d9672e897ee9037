#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "replay/recorded_run.h"
#include "run/run_output.h"
#include "support/temp_folder.h"
#include "terminal/usage_error.h"
#include "view/own_world.h"

namespace tandem::view::test {

/// A folder with a short run of the world cube.
class RunRig : public ::testing::Test {
 protected:
  RunRig() {
    const demos::Scenario scenario =
        tandem::test::loadWorld("cube", {"experiment.duration=1.5", "experiment.axis=[0,1,0]"});
    run = std::make_unique<demos::VirtualRun>(scenario);
    run->run();
    const demos::OutputFolder output(folder, "--out");
    demos::writeRun(output, demos::makeSummary(scenario, *run), *run);
  }

  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream stream(folder / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void write(const std::string& name, const std::string& text) const {
    temporary.write(name, text);
  }
  /// Replaces the first `from` of a file.
  void edit(const std::string& name, const std::string& from, const std::string& to) const {
    std::string text = read(name);
    ASSERT_NE(text.find(from), std::string::npos) << from;
    write(name, text.replace(text.find(from), from.size(), to));
  }
  /// Changes a summary.
  void change(const std::string& name, const std::function<void(nlohmann::json&)>& how) const {
    nlohmann::json json = nlohmann::json::parse(read(name));
    how(json);
    write(name, json.dump(2));
  }

  tandem::test::TempFolder temporary;
  const std::filesystem::path& folder = temporary.path();
  std::unique_ptr<demos::VirtualRun> run;
};

/// The message of the UsageError that `act` throws; empty if it throws none.
inline std::string refusalOf(const std::function<void()>& act) {
  try {
    act();
  } catch (const demos::UsageError& error) {
    return error.what();
  }
  return "";
}

}  // namespace tandem::view::test
