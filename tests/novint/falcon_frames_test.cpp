#include "falcon/src/novint/falcon_frames.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/random.h"

namespace tandem {
namespace {

std::string textOf(const FalconFrame& frame) { return {frame.begin(), frame.end()}; }
FalconFrame frameOf(const std::string& text) {
  FalconFrame frame{};
  std::copy_n(text.begin(), std::min(text.size(), frame.size()), frame.begin());
  return frame;
}

TEST(FalconFrames, KnownCommands) {
  EXPECT_EQ(textOf(encodeCommand({})), "<AAAAAAAAAAAAAA>");
  EXPECT_EQ(textOf(encodeCommand({{}, true, kGreenLight})), "<AAAAAAAAAAAADA>");
  // Bytes that the maker's driver sends for 10 N to the right.
  EXPECT_EQ(textOf(encodeCommand({{-679, 2529, -1862}, false, kBlueLight})), "<JFNPBOJAKLIPEA>");
  EXPECT_EQ(textOf(encodeCommand({{4095, -4095, 1}, true, kBlueLight | kRedLight})),
            "<PPPABAAPBAAANA>");
}

TEST(FalconFrames, KnownReply) {
  EXPECT_EQ(textOf(encodeReply({{-200, -200, -200}, 0, 0})), "<IDPPIDPPIDPPAA>");
  const auto reply = decodeReply(frameOf("<IDPPIDPPIDPPAA>"));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->counts, (std::array<std::int16_t, 3>{-200, -200, -200}));
  EXPECT_FALSE(reply->isHomed());
}

TEST(FalconFrames, CommandsAreClampedAndUnknownBitsAreNotSent) {
  const auto back = decodeCommand(encodeCommand({{32767, -32768, 5}, false, 0xff}));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->motors, (FalconMotors{4095, -4095, 5}));
  EXPECT_EQ(back->lights, kGreenLight | kBlueLight | kRedLight);
  EXPECT_FALSE(back->homes);
}

TEST(FalconFrames, ComeBackAsTheyWere) {
  constexpr std::uint64_t kSeed = 60;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  const auto number = [&](int most) {
    return static_cast<std::int16_t>(random.below(2 * most + 1) - most);
  };
  for (int i = 0; i < 20000; ++i) {
    const FalconCommand command{{number(4095), number(4095), number(4095)},
                                random.below(2) == 1,
                                static_cast<std::uint8_t>(2 * random.below(8))};
    const auto command_back = decodeCommand(encodeCommand(command));
    ASSERT_TRUE(command_back);
    ASSERT_EQ(command_back->motors, command.motors);
    ASSERT_EQ(command_back->homes, command.homes);
    ASSERT_EQ(command_back->lights, command.lights);
    const FalconReply reply{{number(32767), number(32767), number(32767)},
                            static_cast<std::uint8_t>(random.below(8)),
                            static_cast<std::uint8_t>(random.below(16))};
    const auto reply_back = decodeReply(encodeReply(reply));
    ASSERT_TRUE(reply_back);
    ASSERT_EQ(reply_back->counts, reply.counts);
    ASSERT_EQ(reply_back->homed, reply.homed);
    ASSERT_EQ(reply_back->buttons, reply.buttons);
  }
}

TEST(FalconFrames, WhatIsNoFrameIsRefused) {
  const std::string good = "<AAAAAAAAAAAAAA>";
  ASSERT_TRUE(isFrame(frameOf(good)));
  for (std::size_t at = 0; at < good.size(); ++at) {
    for (int byte = 0; byte < 256; ++byte) {
      FalconFrame frame = frameOf(good);
      frame[at] = static_cast<std::uint8_t>(byte);
      const bool is_marker = at == 0 || at == 15, is_free = at == 14;
      const bool is_good = is_free || (is_marker  ? byte == good[at]
                                       : at == 13 ? byte >= 'A' && byte <= 'A' + 127
                                                  : byte >= 'A' && byte < 'A' + 16);
      ASSERT_EQ(isFrame(frame), is_good) << at << " " << byte;
    }
  }
  EXPECT_FALSE(decodeCommand(frameOf("<AAABAAAAAAAAAA>")));  // 4096
  EXPECT_FALSE(decodeCommand(frameOf("<AAAAAAAAAAAAQA>")));  // a reply's info
}

/// Frames that a reader finds in `bytes`.
std::vector<std::string> read(FalconFrameReader& reader, const std::string& bytes) {
  std::vector<std::string> found;
  for (const char byte : bytes)
    if (const auto frame = reader.take(static_cast<std::uint8_t>(byte)))
      found.push_back(textOf(*frame));
  return found;
}

TEST(FalconFrameReader, FindsFramesAmongWhatever) {
  const std::string a = "<IDPPIDPPIDPPAA>", b = "<AAAAAAAAAAAADA>";
  FalconFrameReader reader;
  EXPECT_EQ(read(reader, a + b), (std::vector{a, b}));
  EXPECT_EQ(reader.dropped(), 0u);
  EXPECT_EQ(read(reader, "xx" + a), (std::vector{a}));
  EXPECT_EQ(reader.dropped(), 2u);
  EXPECT_EQ(read(reader, a.substr(0, 14) + b + a), (std::vector{b, a}));  // a short reply
  EXPECT_EQ(reader.dropped(), 16u);
  EXPECT_EQ(read(reader, "<" + a), (std::vector{a}));  // a doubled byte
  EXPECT_EQ(reader.frames(), 6u);
}

TEST(FalconFrameReader, FindsTheNextWholeFrameAfterAnyDamage) {
  constexpr std::uint64_t kSeed = 61;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  for (int round = 0; round < 5000; ++round) {
    FalconFrameReader reader;
    std::string bytes;
    for (int i = 0; i < 3; ++i) bytes += "<IDPPIDPPIDPPAA>";
    for (int i = random.below(6); i > 0; --i) {
      const auto at = static_cast<std::size_t>(random.below(static_cast<int>(bytes.size())));
      switch (random.below(3)) {
        case 0:
          bytes.erase(at, 1);
          break;
        case 1:
          bytes.insert(at, 1, bytes[at]);
          break;
        default:
          bytes[at] = static_cast<char>(random.below(256));
      }
    }
    const std::size_t before = read(reader, bytes).size();
    // The rest of a damaged frame may swallow the first good one, never the second.
    const std::string good = "<AAAAAAAAAAAADA>";
    const auto after = read(reader, good + good);
    ASSERT_FALSE(after.empty());
    ASSERT_EQ(after.back(), good);
    ASSERT_EQ(reader.frames(), before + after.size());
    ASSERT_LE(16 * reader.frames() + reader.dropped(), bytes.size() + 32);
    ASSERT_GT(16 * reader.frames() + reader.dropped() + 16, bytes.size() + 32);
  }
}

}  // namespace
}  // namespace tandem
