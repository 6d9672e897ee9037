// The check that keeps deep TOML from the parser, which follows levels by recursion.

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/plugin/toml_text.h"

#include "demos/program/scenario/toml_input.h"

namespace tandem::test {
namespace {

std::string repeat(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

/// Levels of a parsed value below its own. An array is one level even if it is empty.
int measureBelow(const toml::node& node) {
  int most = node.is_array() ? 1 : 0;
  if (const auto* table = node.as_table())
    for (const auto& [key, value] : *table) most = std::max(most, 1 + measureBelow(value));
  if (const auto* array = node.as_array())
    for (const toml::node& value : *array) most = std::max(most, 1 + measureBelow(value));
  return most;
}

/// Texts that nest `levels` deep, each in another way.
std::vector<std::string> makeDeep(int levels) {
  const std::string dotted = repeat("a.", levels - 1) + "a";
  const std::string quoted = repeat("\"a.b\" . ", levels - 1) + "'c'";
  const int half = levels / 2;
  return {dotted + " = 1\n",
          quoted + " = 1\n",
          "[" + dotted + "]\n",
          "[[" + repeat("a.", levels - 2) + "a]]\n",
          "[" + repeat("a.", half - 1) + "a]\n" + repeat("b.", levels - half - 1) + "b = 1\n",
          "a = " + repeat("[", levels - 1) + repeat("]", levels - 1) + "\n",
          repeat("a = {", levels - 1) + "a = 1" + repeat("}", levels - 1) + "\n",
          "x = [\n 1, { " + repeat("a.", levels - 3) + "a = 2.5 } ]\n"};
}

TEST(TomlNesting, AcceptsTheLimitAndNamesTheLineOfMore) {
  for (const std::string& text : makeDeep(kDeepestToml)) {
    EXPECT_FALSE(findDeepToml("# one\n" + text)) << text;
    EXPECT_NO_THROW((void)toml::parse(text)) << text;
    EXPECT_EQ(measureBelow(toml::parse(text)), kDeepestToml) << text;
  }
  for (const std::string& text : makeDeep(kDeepestToml + 1)) {
    const auto line = findDeepToml("# one\n\n" + text);
    ASSERT_TRUE(line) << text;
    EXPECT_GE(*line, 3) << text;
    EXPECT_LE(*line, 4) << text;
  }
}

TEST(TomlNesting, StringsAndCommentsAreNoLevels) {
  const std::string dots = repeat("a.[{", 100);
  for (const std::string& text :
       {"a = 1 # " + dots + "\n", "a = \"" + dots + "\"\n", "a = '" + dots + "'\n",
        "'" + dots + "' = 1\n", "a = \"\"\"\n" + dots + "\n\"\\\"\"\" " + dots + "\"\"\"\"\"\n",
        "a = '''\n" + dots + "\n''" + dots + "'''''\n", "a = [ # " + dots + "\n 1 ]\n",
        "a = \"\\\\\" # " + dots + "\n", "a = \"\"\nb = ''\n# " + dots + "\n",
        "a = [" + repeat("1.5, ", 100) + "2]\n", repeat("a1.b = 1\n", 1) + repeat("\n", 100)}) {
    EXPECT_NO_THROW((void)toml::parse(text)) << text;
    EXPECT_FALSE(findDeepToml(text)) << text;
  }
}

// They end, and the levels after them count.
TEST(TomlNesting, LevelsAfterStringsAndCommentsCount) {
  const std::string deep = repeat("b.", kDeepestToml) + "b = 1\n";
  for (const std::string start :
       {"a = \"\"\n", "a = \"\"\"x\"\"\"\n", "a = '''''''\n", "a = \"\"\"\"\"\"\"\"\n",
        "a = '\\'\n", "a = \"\\\"\" # c\r\n", "\xEF\xBB\xBF[a]\n", "a = [\"]\", ']', # ]\n]\n",
        "a = {b = 1}\n"}) {
    EXPECT_NO_THROW((void)toml::parse(start)) << start;
    EXPECT_TRUE(findDeepToml(start + deep)) << start;
  }
}

TEST(TomlNesting, DottedKeyOf40000PartsIsRefused) {
  EXPECT_TRUE(findDeepToml(repeat("a.", 40'000) + "a = 1\n"));
  EXPECT_TRUE(findDeepToml(repeat("a.", 40'000)));
  EXPECT_TRUE(findDeepToml("a = " + repeat("[", 40'000)));
}

/// Draws valid TOML texts with all kinds of keys, values, strings and comments.
class Writer {
 public:
  explicit Writer(std::uint64_t seed) : random_(seed) {}

  std::string write() {
    std::string text;
    for (int i = draw(4); i > 0; --i) text += writePair(3) + writeEnd();
    for (int i = draw(4); i > 0; --i) {
      const bool is_array = draw(3) == 0;
      text += (is_array ? "[[" : "[") + writeKey() + (is_array ? "]]" : "]") + writeEnd();
      for (int j = draw(3); j > 0; --j) text += writePair(3) + writeEnd();
    }
    return text;
  }

 private:
  int draw(int below) { return static_cast<int>(random_() % static_cast<std::uint64_t>(below)); }
  std::string pick(const std::vector<std::string>& all) {
    return all[static_cast<std::size_t>(draw(static_cast<int>(all.size())))];
  }
  // Each key has a name of its own, so nothing is defined twice.
  std::string writePart() {
    const std::string name = std::to_string(++names_);
    return pick({name, "'." + name + "[#'", "\"." + name + "\\\"{\"", "k-" + name});
  }
  std::string writeKey() {
    std::string key = writePart();
    for (int i = draw(4); i > 0; --i) key += pick({".", " . ", "\t."}) + writePart();
    return key;
  }
  std::string writePair(int depth) { return writeKey() + pick({"=", " = "}) + writeValue(depth); }
  std::string writeEnd() { return pick({"\n", "\r\n", " # .[{'\"\n", "\n\n"}); }
  std::string writeValue(int depth) {
    const int kind = depth > 0 ? draw(3) : 0;
    if (kind == 0)
      return pick({"1", "-2.5e3", "true", "1979-05-27T07:32:00.5Z", "'.[{'", "\"\\\".[\"", "''",
                   "\"\"\"a\n.[\"\" \\\" \"\"\"\"", "'''\n.{'' '''''"});
    std::string text = kind == 1 ? "[" : "{";
    for (int i = 0, count = draw(4); i < count; ++i) {
      if (i > 0) text += ", ";
      if (kind == 1 && draw(3) == 0) text += " # ]}\n";
      text += kind == 1 ? writeValue(depth - 1) : writePair(depth - 1);
    }
    return text + (kind == 1 ? "]" : "}");
  }

  std::mt19937_64 random_;
  int names_ = 0;
};

// On valid texts the scanner finds the depth of the parsed tree.
TEST(TomlNesting, AgreesWithTheParserOnValidTexts) {
  constexpr std::uint64_t kSeed = 2009;
  for (std::uint64_t seed = kSeed; seed < kSeed + 20'000; ++seed) {
    const std::string text = Writer(seed).write();
    SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + text);
    toml::table table;
    ASSERT_NO_THROW(table = toml::parse(text));
    const int depth = measureBelow(table);
    ASSERT_FALSE(findDeepToml(text, depth));
    ASSERT_TRUE(depth == 0 || findDeepToml(text, depth - 1));
  }
}

}  // namespace
}  // namespace tandem::test
