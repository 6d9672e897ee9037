// Gamepads in a system folder that this test writes.

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "tandem/falcon/event_port.h"

#include "falcon/src/gamepad/event_bits.h"
#include "support/random.h"

namespace tandem {
namespace {

namespace fs = std::filesystem;
using falcon_detail::parseEventBits;

/// Codes of an Xbox 360 pad, a joystick with force and a keyboard, as the kernel writes them.
constexpr const char* kPadKeys = "7cdb000000000000 0 0 0 0\n";
constexpr const char* kPadAxes = "3003f\n";
constexpr const char* kPadEffects = "107030000 0\n";
constexpr const char* kStickKeys = "ff00000000 0 0 0 0\n";
constexpr const char* kStickEffects = "40000 0\n";
constexpr const char* kKeyboardKeys =
    "402000000 3803078f800d001 feffffdfffefffff fffffffffffffffe\n";

class GamepadListTest : public testing::Test {
 protected:
  GamepadListTest() {
    fs::remove_all(root_);
    fs::create_directories(nodes());
  }
  ~GamepadListTest() override { fs::remove_all(root_); }

  [[nodiscard]] std::string system() const { return root_ / "class"; }
  [[nodiscard]] std::string nodes() const { return root_ / "input"; }

  void add(const std::string& node, const std::string& name, const std::string& keys,
           const std::string& axes, const std::string& effects) const {
    const fs::path device = fs::path(system()) / node / "device";
    fs::create_directories(device / "capabilities");
    std::ofstream(device / "name") << name << "\n";
    std::ofstream(device / "capabilities" / "key") << keys;
    std::ofstream(device / "capabilities" / "abs") << axes;
    std::ofstream(device / "capabilities" / "ff") << effects;
    std::ofstream(fs::path(nodes()) / node) << "";
  }

 private:
  const fs::path root_ =
      fs::path(testing::TempDir()) /
      (std::string("tandem_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(GamepadListTest, FindsPadsAndSticksInTheOrderOfTheirNumbers) {
  add("event10", "Stick", kStickKeys, "3\n", kStickEffects);
  add("event2", "Pad", kPadKeys, kPadAxes, kPadEffects);
  add("event3", "Keyboard", kKeyboardKeys, "0\n", "0\n");
  add("js0", "Pad", kPadKeys, kPadAxes, kPadEffects);
  const std::vector<GamepadAddress> found = findGamepads(system(), nodes());
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].path, nodes() + "/event2");
  EXPECT_EQ(found[0].name, "Pad");
  EXPECT_EQ(found[0].feel, Feel::kRumble);
  EXPECT_TRUE(found[0].may_open);
  EXPECT_EQ(found[1].path, nodes() + "/event10");
  EXPECT_EQ(found[1].feel, Feel::kForce);
}

TEST_F(GamepadListTest, TellsANodeThatMayNotBeOpened) {
  add("event2", "Pad", kPadKeys, kPadAxes, "0\n");
  fs::remove(fs::path(nodes()) / "event2");  // root may open any file
  const std::vector<GamepadAddress> found = findGamepads(system(), nodes());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_FALSE(found[0].may_open);
  EXPECT_EQ(found[0].feel, Feel::kNothing);
}

TEST_F(GamepadListTest, PassesOverWhatMakesNoSense) {
  add("event1", "Nothing", "", "", "");
  add("event2", "Words", "pad", "xyz", "-1");
  add("event99999999999999999999", "Pad", kPadKeys, kPadAxes, kPadEffects);
  fs::create_directories(fs::path(system()) / "event5");
  EXPECT_TRUE(findGamepads(system(), nodes()).empty());
  EXPECT_TRUE(findGamepads(system() + "/none", nodes()).empty());
}

TEST_F(GamepadListTest, ANameIsOneLineOfText) {
  add("event1", "A \x1b[31mred\x07 pad " + std::string(300, 'x'), kPadKeys, kPadAxes, "0\n");
  const std::vector<GamepadAddress> found = findGamepads(system(), nodes());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].name.substr(0, 15), "A ?[31mred? pad");
  EXPECT_EQ(found[0].name.size(), 60U);
}

TEST(EventBits, ReadsWordsFromTheLast) {
  const auto bits = parseEventBits("1 8000000000000001\n", 8);
  for (std::size_t code = 0; code < 800; ++code)
    EXPECT_EQ(bits.has(code), code == 0 || code == 63 || code == 64) << code;
  EXPECT_TRUE(parseEventBits("1 0", 4).has(32)) << "a system of 32 bits";
}

TEST(EventBits, AnyTextIsRead) {
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    test::Random random(seed);
    std::string text;
    for (int i = random.below(600); i > 0; --i)
      text +=
          static_cast<char>(random.below(2) == 0 ? random.below(256) : "0f \n"[random.below(4)]);
    const auto bits = parseEventBits(text, 8);
    EXPECT_FALSE(bits.has(768));
    const std::string printable = falcon_detail::toPrintable(text);
    for (const char c : printable) EXPECT_TRUE(c >= ' ' && c <= '~');
  }
}

TEST(OpenGamepad, RefusesWhatIsNoInputDevice) {
  const auto refusal = [](const std::string& path) {
    try {
      (void)openGamepad(path);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("opened");
  };
  EXPECT_EQ(refusal("/dev/null"),
            "/dev/null is no input device; give the path of one, such as /dev/input/event5");
  EXPECT_EQ(
      refusal("/dev/input/tandem-none"),
      "/dev/input/tandem-none cannot be opened (No such file or directory); see tandem device "
      "list");
}

}  // namespace
}  // namespace tandem
