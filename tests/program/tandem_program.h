#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "program/process.h"

/// \file
/// The programs of this build. The build defines their paths for tandem_program.cpp alone, so that
/// clones share what they compile of all other tests.
namespace tandem::test {

/// Path of the program on float64 Bullet.
[[nodiscard]] std::string tandemProgram();
/// Path of the program on float Bullet; with TANDEM_WITH_FLOAT.
[[nodiscard]] std::string tandemFloatProgram();
/// Path of the reader of states over DDS; where Cyclone DDS is installed.
[[nodiscard]] std::string statesReader();

/// Runs the program on float64 Bullet to its end.
[[nodiscard]] Outcome runTandem(const std::vector<std::string>& arguments, const Start& start = {});

/// Runs them at the same time; outcomes in the order of the lines.
[[nodiscard]] std::vector<Outcome> runAtOnce(const std::vector<std::vector<std::string>>& lines);

/// Path of a scenario that ships with the program.
[[nodiscard]] std::string scenarioPath(std::string_view name);

}  // namespace tandem::test
