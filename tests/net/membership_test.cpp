// Random scripts of events on sites and datagrams. tests/fuzz/membership_fuzzer.cpp searches for
// scripts that break a property.

#include <string>

#include <gtest/gtest.h>

#include "net/membership_script.h"
#include "net/virtual_net.h"

namespace tandem {
namespace {

std::string write(const std::vector<std::uint8_t>& script) {
  std::string text;
  for (const std::uint8_t byte : script) text += std::to_string(byte) + " ";
  return text;
}

std::string play(const std::vector<std::uint8_t>& script) {
  return test::playMembershipScript({script.data(), script.size()});
}

TEST(Membership, DrawnScriptsEndTogether) {
  constexpr std::uint64_t kSeed = 20090407;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  const std::uint64_t count = test::readCount("TANDEM_MEMBERSHIP_SCRIPTS", 200);
  for (std::uint64_t i = 0; i < count; ++i) {
    std::vector<std::uint8_t> script(static_cast<std::size_t>(random.below(600)));
    for (std::uint8_t& byte : script) byte = static_cast<std::uint8_t>(random.below(256));
    ASSERT_EQ(play(script), "") << write(script);
  }
}

// OPEN is answered, the responder restarts, and the answer arrives a minute later.
TEST(Membership, AnswerOfAPeerThatHasBegunAnewIsGotOver) {
  EXPECT_EQ(play({0, 11, 0, 3, 1, 1, 11, 0, 3, 1, 7, 1, 0, 10, 12, 1}), "");
}

// A bit of the COOKIE is turned: its tag is wrong, so no OPEN repeats it.
TEST(Membership, AChangedCookieIsRefused) {
  EXPECT_EQ(
      play({0, 11, 0, 3,  4,  0, 24, 18, 1,  4, 0, 33, 1, 1, 11, 0, 3,  4, 0, 50, 8,  4, 0, 33,
            8, 37, 0, 24, 18, 1, 4,  0,  33, 1, 1, 11, 0, 3, 4,  0, 50, 8, 4, 0,  33, 8, 37}),
      "");
}

// Datagrams that lay for 8.75 s make a round trip of as much, and then a site moves. The check of
// its address waited for one and a half of these.
TEST(Membership, ASiteThatMovesAfterALongRoundTripIsFound) {
  EXPECT_EQ(play({0, 13, 16, 11, 1, 4, 9, 0, 2, 13, 4,   9, 1,  0, 10, 9,  11, 0, 3,
                  3, 3,  0,  3,  1, 1, 1, 1, 1, 14, 255, 0, 14, 3, 0,  14, 4,  1}),
            "");
}

// The network stands still for two minutes, so a round trip of one is measured. Then a site moves
// twice: each check of its address waited for one and a half of 5 s.
TEST(Membership, ASiteThatMovesTwiceAfterAStandstillIsFound) {
  EXPECT_EQ(play({0, 9, 0, 1, 13, 9, 11, 14, 0, 9, 0, 2, 13, 9}), "");
}

// Both sites move, so the initiator's new keys never come into use. While it calls again, a
// datagram under the keys before them comes. It ended the call after the peer had answered, so that
// the sites had no keys in common.
TEST(Membership, ADatagramUnderReplacedKeysEndsNoCall) {
  EXPECT_EQ(play({4, 9, 0, 2, 13, 10, 9, 11, 2, 13, 4, 11, 14, 3, 1, 1}), "");
}

}  // namespace
}  // namespace tandem
