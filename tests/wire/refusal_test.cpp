// Datagrams that must be refused: golden/refused.txt line by line, every truncation, every flipped
// bit.

#include <memory>
#include <random>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "coordination/src/wire/wire_sealing.h"
#include "wire/golden.h"
#include "wire/opened_datagram.h"

namespace tandem {
namespace {

using test::Bytes;
using test::findRefusal;
using test::readGolden;
using test::viewOf;

const std::vector<std::string> kDatagrams = {"hello.bin",
                                             "cookie.bin",
                                             "open.bin",
                                             "accept.bin",
                                             "refuse_key.bin",
                                             "refuse_version.bin",
                                             "state_float32.bin",
                                             "state_float64.bin",
                                             "state_full.bin",
                                             "agree.bin",
                                             "bye.bin",
                                             "state_device_only.bin",
                                             "agree_ack_same.bin",
                                             "agree_ack_different.bin"};

/// Copies into memory of exactly this size, so that a sanitizer detects a read past its end.
WireRefusal findRefusalOfCopy(const Bytes& bytes, std::size_t size) {
  const std::unique_ptr<std::uint8_t[]> copy(new std::uint8_t[size]);
  std::copy_n(bytes.begin(), size, copy.get());
  return findRefusal({copy.get(), size});
}

Bytes fromHex(const std::string& hex) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(hex.substr(i, 2), nullptr, 16)));
  return bytes;
}

/// Applies OFFSET:BYTES.
void patch(const std::string& word, Bytes& bytes) {
  const std::size_t colon = word.find(':');
  const Bytes replacement = fromHex(word.substr(colon + 1));
  const std::size_t offset = std::stoul(word.substr(0, colon));
  ASSERT_LE(offset + replacement.size(), bytes.size()) << word;
  std::copy(replacement.begin(), replacement.end(),
            bytes.begin() + static_cast<std::ptrdiff_t>(offset));
}

TEST(WireRefusals, AreNamedAsTheStandardSays) {
  const Bytes file = readGolden("refused.txt");
  std::istringstream lines(std::string(file.begin(), file.end()));
  std::set<std::string> seen = {"none", "terms"};  // WireRefusals.Terms below covers terms
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string refusal, golden, size;
    if (!(words >> refusal) || refusal == "#") continue;
    words >> golden >> size;
    Bytes bytes = readGolden(golden);
    if (size != "-") bytes.resize(std::stoul(size));
    for (std::string word; words >> word;) patch(word, bytes);
    EXPECT_EQ(name(findRefusalOfCopy(bytes, bytes.size())), refusal) << line;
    seen.insert(refusal);
  }
  for (std::size_t i = 0; i < kWireRefusals; ++i)
    EXPECT_EQ(seen.count(name(static_cast<WireRefusal>(i))), 1U)
        << name(static_cast<WireRefusal>(i));
  EXPECT_EQ(seen.size(), kWireRefusals);
}

TEST(WireRefusals, EveryTruncationIsRefused) {
  for (const std::string& file : kDatagrams) {
    const Bytes golden = readGolden(file);
    EXPECT_EQ(findRefusal(viewOf(golden)), WireRefusal::kNone) << file;
    for (std::size_t size = 0; size < golden.size(); ++size) {
      const WireRefusal refusal = findRefusalOfCopy(golden, size);
      EXPECT_TRUE(refusal == WireRefusal::kTooShort || refusal == WireRefusal::kWrongSize)
          << file << " cut to " << size << ": " << name(refusal);
    }
  }
}

TEST(WireRefusals, EveryLongerOneIsRefused) {
  for (const std::string& file : kDatagrams) {
    Bytes longer = readGolden(file);
    longer.push_back(0);
    EXPECT_EQ(findRefusal(viewOf(longer)), WireRefusal::kWrongSize) << file;
    longer.resize(kMaxDatagramSize);
    EXPECT_NE(findRefusal(viewOf(longer)), WireRefusal::kNone) << file;
    longer.resize(kMaxDatagramSize + 1);
    EXPECT_EQ(findRefusal(viewOf(longer)), WireRefusal::kTooLong) << file;
  }
}

TEST(WireRefusals, NoneOfAnotherType) {
  for (const std::string& file : kDatagrams) {
    const Bytes golden = readGolden(file);
    const ByteView bytes = viewOf(golden);
    const auto header = decodeHeader(bytes);
    ASSERT_TRUE(header);
    EXPECT_EQ(static_cast<bool>(decodeHello(bytes)), header->type == MessageType::kHello);
    EXPECT_EQ(static_cast<bool>(decodeCookie(bytes)), header->type == MessageType::kCookie);
    EXPECT_EQ(static_cast<bool>(decodeOpen(bytes)), header->type == MessageType::kOpen);
    EXPECT_EQ(static_cast<bool>(decodeAccept(bytes)), header->type == MessageType::kAccept);
    EXPECT_EQ(static_cast<bool>(decodeRefuse(bytes)), header->type == MessageType::kRefuse);
  }
}

TEST(WireRefusals, Terms) {
  EXPECT_EQ(readSessionTerms(writeSessionTerms({0, 1, 0})).refusal(), WireRefusal::kTerms);
  EXPECT_EQ(readSessionTerms(writeSessionTerms({1, 0, 0})).refusal(), WireRefusal::kTerms);
  SessionTermsBytes bytes = writeSessionTerms({1, 1, 255});
  EXPECT_TRUE(readSessionTerms(bytes));
  bytes.back() = 1;
  EXPECT_EQ(readSessionTerms(bytes).refusal(), WireRefusal::kZero);
}

// Damaged bytes that pass by chance are still a valid message of a peer.
TEST(WireRefusals, SpoiltBytesGiveARefusalOrASaneState) {
  constexpr std::uint64_t kSeed = 1;
  std::mt19937_64 random(kSeed);
  for (const std::string& file : kDatagrams) {
    const Bytes golden = readGolden(file);
    for (int i = 0; i < 2000; ++i) {
      Bytes bytes = golden;
      for (std::uint64_t flips = 1 + random() % 4; flips > 0; --flips) {
        const std::uint64_t bit = random() % (8 * bytes.size());
        bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ 1U << (bit % 8));
      }
      if (findRefusal(viewOf(bytes)) != WireRefusal::kNone) continue;
      const auto header = decodeHeader(viewOf(bytes));
      if (header->type != MessageType::kState) continue;
      const auto message = decodeState(payloadOf(viewOf(bytes)), header->sender);
      ASSERT_TRUE(isSane(message->packet)) << file << ", seed " << kSeed << ", case " << i;
    }
  }
}

}  // namespace
}  // namespace tandem
