#include "falcon/src/hid/hid_uart.h"

#include <numeric>

#include <gtest/gtest.h>

#include "devices/ft260_emulator.h"
#include "falcon/src/hid/ft260_reports.h"

namespace tandem {
namespace {

using test::Bytes;
using test::bytesOf;

Bytes makeRamp(std::size_t count) {
  Bytes bytes(count);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{1});
  return bytes;
}

TEST(Ft260Reports, AFrameOf16BytesIsF310AndTheFrame) {
  const Bytes frame = makeRamp(16);
  Bytes expected = {0xF3, 0x10};
  expected.insert(expected.end(), frame.begin(), frame.end());
  EXPECT_EQ(bytesOf(encodeUartBytes(frame.data(), frame.size())), expected);
}

TEST(Ft260Reports, AllSizesArePaddedToFourAndReadBack) {
  const Bytes bytes = makeRamp(100);
  for (std::size_t count = 1; count <= 60; ++count) {
    const HidReport report = encodeUartBytes(bytes.data(), count);
    EXPECT_EQ(report.bytes[0], 0xF0 + (count - 1) / 4);
    EXPECT_EQ(report.bytes[1], count);
    EXPECT_EQ(report.size, 2 + (count + 3) / 4 * 4);
    const auto content = decodeUartBytes(report.bytes.data(), report.size);
    ASSERT_TRUE(content);
    EXPECT_EQ(content->count, count);
    EXPECT_TRUE(std::equal(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count),
                           content->bytes.begin()));
  }
  EXPECT_EQ(encodeUartBytes(bytes.data(), 0).size, 0U);
  EXPECT_EQ(encodeUartBytes(bytes.data(), 100).bytes[1], 60);
}

TEST(Ft260Reports, RefusesWhatIsNotAboutBytesOrClaimsTooMany) {
  const auto isTaken = [](const Bytes& report) {
    return decodeUartBytes(report.data(), report.size()).has_value();
  };
  EXPECT_TRUE(isTaken({0xF0, 4, 1, 2, 3, 4}));
  EXPECT_TRUE(isTaken({0xF0, 1, 1})) << "padding may be left out";
  EXPECT_FALSE(isTaken({0xF0, 5, 1, 2, 3, 4, 5})) << "more than its identifier allows";
  EXPECT_FALSE(isTaken({0xF1, 5, 1, 2, 3, 4})) << "more than there are";
  EXPECT_FALSE(isTaken({0xF0, 0, 1, 2, 3, 4}));
  EXPECT_FALSE(isTaken({0xFF, 1, 1, 2, 3, 4}));
  EXPECT_FALSE(isTaken({0xEF, 1, 1, 2, 3, 4}));
  EXPECT_FALSE(isTaken({0xB1, 1, 1, 2, 3, 4}));
  EXPECT_FALSE(isTaken({0xF0, 1}));
  EXPECT_FALSE(isTaken({0xF0}));
  EXPECT_FALSE(isTaken({}));
}

TEST(Ft260Reports, SettingsAreAsInTheChipsDocument) {
  EXPECT_EQ(bytesOf(makeUartOn()), (Bytes{0xA1, 0x03, 0x04}));
  EXPECT_EQ(bytesOf(makeUartLine(1'500'000)),
            (Bytes{0xA1, 0x41, 0x04, 0x60, 0xE3, 0x16, 0x00, 0x08, 0, 0, 0}));
}

class HidUartTest : public testing::Test {
 protected:
  test::FakeHidDevice fake_;
  std::unique_ptr<ByteTransport> line_ = makeHidUart(fake_.opener()());
};

TEST_F(HidUartTest, SetsTheLineThatAFalconNeeds) {
  EXPECT_TRUE(line_->setLine({1'500'000, 1, true, true}));
  test::Ft260Emulator chip;
  for (const Bytes& feature : fake_.features()) chip.take(feature);
  EXPECT_TRUE(chip.isOn());
  EXPECT_EQ(chip.baud(), 1'500'000);
  EXPECT_FALSE(line_->setLine({1'199, 1, false, false}));
  EXPECT_FALSE(line_->setLine({12'000'001, 1, false, false}));
}

TEST_F(HidUartTest, SendsInPiecesOfSixtyBytes) {
  const Bytes bytes = makeRamp(130);
  ASSERT_TRUE(line_->write(bytes.data(), bytes.size()));
  Bytes sent;
  const auto outputs = fake_.outputs();
  ASSERT_EQ(outputs.size(), 3U);
  for (const Bytes& report : outputs)
    sent.insert(sent.end(), report.begin() + 2, report.begin() + 2 + report[1]);
  EXPECT_EQ(sent, bytes);
}

TEST_F(HidUartTest, KeepsWhatThereIsNoRoomForAndSkipsOtherReports) {
  fake_.send({0xB1, 0, 0});
  fake_.send({0xF0, 4, 1, 2, 3, 4});
  fake_.send({0xF0, 9, 1, 2, 3, 4});
  fake_.send({0xF0, 1, 5, 0, 0, 0});
  Bytes heard;
  std::uint8_t room[3];
  while (heard.size() < 5) {
    const std::ptrdiff_t count = line_->read(room, sizeof room, 10.0);
    ASSERT_GT(count, 0);
    heard.insert(heard.end(), room, room + count);
  }
  EXPECT_EQ(heard, (Bytes{1, 2, 3, 4, 5}));
  EXPECT_EQ(line_->read(room, sizeof room, 0.0), 0);
}

TEST_F(HidUartTest, PurgeForgetsWhatHasCome) {
  std::uint8_t byte = 0;
  fake_.send({0xF0, 2, 1, 2, 0, 0});
  ASSERT_EQ(line_->read(&byte, 1, 10.0), 1);
  fake_.send({0xF0, 1, 3, 0, 0, 0});
  line_->purge();
  EXPECT_EQ(line_->read(&byte, 1, 0.0), 0);
}

TEST_F(HidUartTest, SaysThatTheDeviceIsGone) {
  fake_.setPluggedIn(false);
  std::uint8_t byte = 0;
  EXPECT_LT(line_->read(&byte, 1, 0.0), 0);
  EXPECT_FALSE(line_->write(&byte, 1));
  EXPECT_FALSE(line_->setLine({1'500'000, 1, false, false}));
  line_->purge();
}

TEST(HidUart, RefusesABridgeThatIsTooSlowOrIsNone) {
  EXPECT_THROW(requireFastBridge({0x10C4, 0xEA80, 0, 0, 0, "", "CP2110"}), Error);
  EXPECT_NO_THROW(requireFastBridge(kFt260));
  test::FakeHidDevice fake;
  auto port = fake.opener()();
  fake.setPluggedIn(false);
  EXPECT_THROW((void)makeHidUart(std::move(port)), Error);
}

}  // namespace
}  // namespace tandem
