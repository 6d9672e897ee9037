#include <algorithm>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "coordination/src/wire/wire_agree.h"
#include "wire/golden.h"

namespace tandem {
namespace {

using test::Bytes;
using test::collect;
using test::viewOf;

Bytes encode(const AgreePart& part) {
  return collect([&](ByteSpan out) { return encodeAgree(part, out); });
}

Bytes encode(const AgreeAnswer& answer) {
  return collect([&](ByteSpan out) { return encodeAgreeAck(answer, out); });
}

/// A configuration of `count` items whose keys and values have any allowed length.
Configuration drawConfiguration(std::mt19937_64& random, std::size_t count) {
  std::vector<ConfigurationItem> items;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string key = "k" + std::to_string(i) + std::string(random() % 58, 'x');
    items.push_back({key, std::string(1 + random() % 255, '0')});
  }
  return makeConfiguration(items);
}

TEST(Configuration, IsSortedAndChecked) {
  const Configuration made = makeConfiguration({{"b", "2"}, {"a.c", "3"}, {"a", "1"}});
  EXPECT_EQ(made, (Configuration{{"a", "1"}, {"a.c", "3"}, {"b", "2"}}));
  EXPECT_THROW((void)makeConfiguration({{"a", "1"}, {"a", "2"}}), std::invalid_argument);
  EXPECT_THROW((void)makeConfiguration({{"", "1"}}), std::invalid_argument);
  EXPECT_THROW((void)makeConfiguration({{"a=b", "1"}}), std::invalid_argument);
  EXPECT_THROW((void)makeConfiguration({{"a", ""}}), std::invalid_argument);
  EXPECT_THROW((void)makeConfiguration({{"a", "1\n2"}}), std::invalid_argument);
}

TEST(Configuration, KeysAndValuesHaveLimits) {
  EXPECT_TRUE(isConfigurationKey(std::string(64, 'a')));
  EXPECT_FALSE(isConfigurationKey(std::string(65, 'a')));
  EXPECT_TRUE(isConfigurationValue(std::string(255, ' ')));
  EXPECT_FALSE(isConfigurationValue(std::string(256, ' ')));
  for (const char* good : {"~", "\xc2\xa0", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf",
                           "\xef\xbf\xbf", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"})
    EXPECT_TRUE(isConfigurationValue(good)) << good;
  for (const char* bad :
       {"\x1f", "\x7f", "\x80", "\xc2", "\xc0\x80", "\xc1\xbf", "\xc2\x80", "\xc2\x9f", "\xc2z",
        "\xe0\x9f\xbf", "\xe1\x80", "\xed\xa0\x80", "\xf0\x8f\xbf\xbf", "\xf4\x90\x80\x80",
        "\xf1\x80\x80", "\xf5\x80\x80\x80", "\xff", "ok\xc3"})
    EXPECT_FALSE(isConfigurationValue(bad)) << bad;
}

TEST(Configuration, HashSeesEveryChange) {
  EXPECT_EQ(hashConfiguration({}), 0x4fd0bfc1U) << "FNV-1a of nothing, folded";
  const auto hash = [](const char* key, const char* value) {
    return hashConfiguration({{key, value}});
  };
  EXPECT_EQ(hash("a", "1"), hash("a", "1"));
  EXPECT_NE(hash("a", "1"), hash("a", "2"));
  EXPECT_NE(hash("a", "1"), hash("b", "1"));
  EXPECT_NE(hashConfiguration({{"a", "1"}, {"b", "1"}}), hash("a", "1"));
}

TEST(Configuration, FirstDifferenceIsNamed) {
  const Configuration base = makeConfiguration({{"a", "1"}, {"c", "2"}});
  EXPECT_FALSE(findFirstDifference(base, base));
  const auto expect = [&](const Configuration& there, const char* key, const char* here,
                          const char* value) {
    const auto found = findFirstDifference(base, there);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->key, key);
    EXPECT_EQ(found->here, here);
    EXPECT_EQ(found->there, value);
  };
  expect({{"a", "1"}, {"c", "3"}}, "c", "2", "3");
  expect({{"a", "1"}, {"b", "9"}, {"c", "2"}}, "b", "", "9");
  expect({{"c", "2"}}, "a", "1", "");
  expect({{"a", "1"}}, "c", "2", "");
  expect({{"a", "1"}, {"c", "2"}, {"d", "4"}}, "d", "", "4");
  expect({}, "a", "1", "");
}

TEST(WireAgree, ConfigurationsOfAnySizeComeAcross) {
  constexpr std::uint64_t kSeed = 4;
  std::mt19937_64 random(kSeed);
  for (const std::size_t count : {0U, 1U, 3U, 20U, 100U}) {
    const Configuration configuration = drawConfiguration(random, count);
    auto parts = makeAgreeParts(configuration);
    std::shuffle(parts.begin(), parts.end(), random);
    parts.push_back(parts.front());  // one item occurs twice
    AgreeCollector collector;
    for (const AgreePart& part : parts) {
      const Bytes bytes = encode(part);
      ASSERT_FALSE(bytes.empty());
      ASSERT_LE(bytes.size(), kMaxPayloadSize);
      const auto got = decodeAgree(viewOf(bytes));
      ASSERT_TRUE(got) << name(got.refusal());
      ASSERT_TRUE(collector.add(*got));
    }
    EXPECT_TRUE(collector.complete());
    EXPECT_EQ(collector.answer(configuration).verdict, AgreeVerdict::kEqual) << count << " items";
  }
}

TEST(WireAgree, TooLongAConfigurationIsSaidSo) {
  std::mt19937_64 random(5);
  EXPECT_THROW((void)makeAgreeParts(drawConfiguration(random, 1000)), std::invalid_argument);
}

TEST(WireAgree, AnswersTellWhatIsMissingAndWhatDiffers) {
  std::mt19937_64 random(6);
  const Configuration theirs = drawConfiguration(random, 30);
  const auto parts = makeAgreeParts(theirs);
  ASSERT_GT(parts.size(), 2U);
  AgreeCollector collector;
  ASSERT_TRUE(collector.add(parts[1]));
  AgreeAnswer answer = collector.answer(theirs);
  EXPECT_EQ(answer.verdict, AgreeVerdict::kIncomplete);
  EXPECT_EQ(answer.parts_received, 2U);
  EXPECT_EQ(answer.config_hash, hashConfiguration(theirs));
  for (const AgreePart& part : parts) ASSERT_TRUE(collector.add(part));

  Configuration mine = theirs;
  mine[7].value = "mine";
  answer = collector.answer(mine);
  EXPECT_EQ(answer.verdict, AgreeVerdict::kDifferent);
  EXPECT_EQ(answer.key, theirs[7].key);
  EXPECT_EQ(answer.value, "mine");
  EXPECT_FALSE(encode(answer).empty());
  mine.erase(mine.begin());
  EXPECT_EQ(collector.answer(mine).value, "") << "I have no such item";
}

TEST(WireAgree, AnotherConfigurationBeginsAnew) {
  const auto first = makeAgreeParts(makeConfiguration({{"a", "1"}}));
  const auto second = makeAgreeParts(makeConfiguration({{"a", "2"}}));
  AgreeCollector collector;
  EXPECT_FALSE(collector.complete());
  EXPECT_TRUE(collector.add(first[0]));
  EXPECT_TRUE(collector.add(second[0]));
  EXPECT_EQ(collector.answer({{"a", "2"}}).verdict, AgreeVerdict::kEqual);

  AgreePart odd = second[0];
  odd.parts = 2;
  EXPECT_FALSE(collector.add(odd)) << "of another number of parts";
  odd.parts = 33;
  EXPECT_FALSE(collector.add(odd));
}

TEST(WireAgree, PartsThatDoNotMakeTheirHashAreForgotten) {
  AgreePart part = makeAgreeParts(makeConfiguration({{"a", "1"}}))[0];
  part.items[0].value = "2";
  AgreeCollector collector;
  EXPECT_TRUE(collector.add(part));
  EXPECT_EQ(collector.answer({{"a", "2"}}).verdict, AgreeVerdict::kIncomplete);
  EXPECT_EQ(collector.partsReceived(), 0U);
}

TEST(WireAgree, SendersKeepToTheStandard) {
  const AgreePart good = makeAgreeParts(test::makeGoldenConfiguration())[0];
  std::vector<AgreePart> bad(6, good);
  bad[0].part = 1;
  bad[1].parts = 0;
  bad[2].parts = 33;
  std::swap(bad[3].items[0], bad[3].items[1]);
  bad[4].items[0].key.clear();
  bad[5].items[0].value = "\x1b[2J";
  for (const AgreePart& part : bad) EXPECT_TRUE(encode(part).empty());

  EXPECT_TRUE(encode(AgreeAnswer{1, 1, AgreeVerdict::kEqual, "a", ""}).empty());
  EXPECT_TRUE(encode(AgreeAnswer{1, 1, AgreeVerdict::kIncomplete, "", "1"}).empty());
  EXPECT_TRUE(encode(AgreeAnswer{1, 1, AgreeVerdict::kDifferent, "", "1"}).empty());
  EXPECT_TRUE(encode(AgreeAnswer{1, 1, AgreeVerdict{3}, "", ""}).empty());
  EXPECT_FALSE(encode(AgreeAnswer{1, 1, AgreeVerdict::kDifferent, "a", ""}).empty());

  Bytes bytes(200, 0xee);
  const std::size_t size = encode(good).size();
  EXPECT_EQ(encodeAgree(good, {bytes.data(), size - 1}), 0U);
  EXPECT_EQ(encodeAgreeAck({}, {bytes.data(), 10}), 0U);
  EXPECT_EQ(bytes, Bytes(200, 0xee));
}

}  // namespace
}  // namespace tandem
