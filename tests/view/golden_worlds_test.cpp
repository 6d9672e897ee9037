// What pictures of the worlds of demos/worlds show at 0, 1 and 3 s of virtual time, as text. To
// store what is drawn now, run this test with TANDEM_WRITE_GOLDEN=1 in the environment, and look at
// the films.

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "run/virtual_run.h"
#include "scene/draw_text.h"
#include "session/scene_look.h"
#include "support/checkout.h"
#include "view/own_world.h"

namespace tandem::view {
namespace {

namespace fs = std::filesystem;

const fs::path kGolden = tandem::test::inCheckout("tests/view/golden");
constexpr double kTolerance = 2e-4;  // of places [m] and turns

std::vector<std::string> listWorlds() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(tandem::test::inCheckout("demos/worlds")))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem());
  return names;
}

std::string describe(const std::string& world) {
  const demos::Scenario scenario = tandem::test::loadWorld(world, {"experiment.duration=3"});
  demos::VirtualRun run(scenario);
  SceneLook look(run.world(0));
  std::string text = "0 s\n" + writeDrawList(look.look());
  run.run([&](double share) {
    for (const double time : {1.0, 3.0})
      if (std::abs(share * 3.0 - time) < 1e-9)
        text += std::to_string(static_cast<int>(time)) + " s\n" + writeDrawList(look.look());
  });
  return text;
}

bool isSame(const std::string& word, const std::string& stored) {
  if (word == stored) return true;
  char* end = nullptr;
  const double number = std::strtod(word.c_str(), &end);
  if (end == word.c_str() || *end != '\0') return false;
  return std::abs(number - std::strtod(stored.c_str(), nullptr)) < kTolerance;
}

void expectSame(const std::string& text, const std::string& stored) {
  std::istringstream lines(text), stored_lines(stored);
  for (std::string line, stored_line; std::getline(lines, line);) {
    ASSERT_TRUE(std::getline(stored_lines, stored_line)) << "not stored: " << line;
    std::istringstream words(line), stored_words(stored_line);
    for (std::string word, stored_word; words >> word;) {
      stored_words >> stored_word;
      ASSERT_TRUE(isSame(word, stored_word)) << line << "\nstored: " << stored_line;
    }
  }
  std::string more;
  EXPECT_FALSE(std::getline(stored_lines, more)) << "stored, not drawn: " << more;
}

class GoldenWorlds : public testing::TestWithParam<std::string> {};

TEST_P(GoldenWorlds, AreDrawnAsStored) {
  const fs::path file = kGolden / (GetParam() + ".txt");
  const std::string text = describe(GetParam());
  if (std::getenv("TANDEM_WRITE_GOLDEN")) std::ofstream(file) << text;
  std::ifstream stream(file);
  ASSERT_TRUE(stream) << file << " is missing";
  std::ostringstream stored;
  stored << stream.rdbuf();
  expectSame(text, stored.str());
}

INSTANTIATE_TEST_SUITE_P(, GoldenWorlds, testing::ValuesIn(listWorlds()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace tandem::view
