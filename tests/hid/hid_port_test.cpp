#include "tandem/falcon/hid_port.h"

#include <future>

#include <gtest/gtest.h>

#include "falcon/src/hid/space_mouse_emulator.h"
#include "hid/user_hidraw.h"

namespace tandem {
namespace {

using test::Bytes;
using test::UserHidraw;

std::string refusalOf(const HidAddress& address) {
  try {
    (void)openHid(address);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// A report that encodes its number, with varying length.
Bytes makeNumbered(int number) {
  Bytes report(2 + static_cast<std::size_t>(number) % 63);
  for (std::size_t i = 0; i < report.size(); ++i)
    report[i] = static_cast<std::uint8_t>(number >> (8 * (i % 3)));
  return report;
}

class HidPortTest : public testing::Test {
 protected:
  UserHidraw node_{"port", makeSpaceMouseDescriptor(SpaceMouseLayout::kOld)};
  std::unique_ptr<HidPort> port_ = openHid(node_.address());
};

// Each frame goes to the device and back. All bytes are compared both ways.
TEST_F(HidPortTest, CarriesTwentyThousandFramesThereAndBack) {
  constexpr int kCount = 20'000;
  auto device = std::async(std::launch::async, [&] {
    for (int i = 0; i < kCount; ++i) {
      const auto output = node_.receive(10.0);
      if (!output || *output != makeNumbered(i) || !node_.send(*output)) return i;
    }
    return kCount;
  });
  int heard = 0;
  for (; heard < kCount; ++heard) {
    const Bytes frame = makeNumbered(heard);
    if (!port_->write(frame.data(), frame.size())) break;
    Bytes reply(kMostHidReport);
    const std::ptrdiff_t size = port_->read(reply.data(), reply.size(), 10.0);
    if (size != static_cast<std::ptrdiff_t>(frame.size())) break;
    reply.resize(frame.size());
    if (reply != frame) break;
  }
  EXPECT_EQ(heard, kCount);
  EXPECT_EQ(device.get(), kCount);
}

// Like HidStream: hidapi must support one reading and one writing thread.
TEST_F(HidPortTest, CarriesBothWaysAtOnce) {
  constexpr int kCount = 20'000;
  auto sender = std::async(std::launch::async, [&] {
    for (int i = 0; i < kCount; ++i)
      if (!node_.send(makeNumbered(i))) return i;
    return kCount;
  });
  auto receiver = std::async(std::launch::async, [&] {
    for (int i = 0; i < kCount; ++i)
      if (node_.receive(10.0) != makeNumbered(i)) return i;
    return kCount;
  });
  auto writer = std::async(std::launch::async, [&] {
    for (int i = 0; i < kCount; ++i) {
      const Bytes frame = makeNumbered(i);
      if (!port_->write(frame.data(), frame.size())) return i;
    }
    return kCount;
  });
  int heard = 0;
  for (; heard < kCount; ++heard) {
    Bytes report(kMostHidReport);
    const std::ptrdiff_t size = port_->read(report.data(), report.size(), 10.0);
    if (size < 0) break;
    report.resize(static_cast<std::size_t>(size));
    if (report != makeNumbered(heard)) break;
  }
  EXPECT_EQ(heard, kCount);
  EXPECT_EQ(writer.get(), kCount);
  EXPECT_EQ(receiver.get(), kCount);
  EXPECT_EQ(sender.get(), kCount);
}

TEST_F(HidPortTest, CutsOffWhatThereIsNoRoomFor) {
  ASSERT_TRUE(node_.send({1, 2, 3, 4}));
  ASSERT_TRUE(node_.send({5}));
  std::uint8_t room[2] = {};
  EXPECT_EQ(port_->read(room, 2, 10.0), 2);
  EXPECT_EQ(room[1], 2);
  EXPECT_EQ(port_->read(room, 2, 10.0), 1);
  EXPECT_EQ(room[0], 5);
  EXPECT_EQ(port_->read(room, 2, 0.0), 0) << "nothing has come";
}

TEST_F(HidPortTest, FeatureReportsGoBothWays) {
  Bytes taken;
  node_.setFeatures([&](const Bytes& report) { taken = report; },
                    [](std::uint8_t id) {
                      return id == 7 ? Bytes{7, 42} : Bytes{};
                    });
  const Bytes feature = {0xA1, 3, 4};
  EXPECT_TRUE(port_->setFeature(feature.data(), feature.size()));
  EXPECT_EQ(taken, feature);
  std::uint8_t answer[8] = {7};
  EXPECT_EQ(port_->getFeature(answer, sizeof answer), 2);
  EXPECT_EQ(answer[1], 42);
  answer[0] = 8;
  EXPECT_LT(port_->getFeature(answer, sizeof answer), 0);
  node_.setFeatures(nullptr, nullptr);
  EXPECT_FALSE(port_->setFeature(feature.data(), feature.size()));
}

TEST_F(HidPortTest, SeesThatTheDeviceIsUnplugged) {
  node_.unplug();
  std::uint8_t byte = 0;
  EXPECT_LT(port_->read(&byte, 1, 10.0), 0);
  EXPECT_LT(port_->read(&byte, 1, 10.0), 0) << "and goes on seeing it";
  EXPECT_FALSE(port_->write(&byte, 1));
  EXPECT_NE(refusalOf(node_.address()), "");
}

TEST_F(HidPortTest, IsNamedByWhatIsKnown) {
  EXPECT_EQ(port_->name(), "HID (/dev/hidraw-port)");
  HidAddress address = node_.address();
  address.vendor = 0x256F;
  address.product = 0xC635;
  address.product_name = "SpaceMouse Compact";
  EXPECT_EQ(openHid(address)->name(), "HID 256f:c635 SpaceMouse Compact (/dev/hidraw-port)");
}

TEST_F(HidPortTest, WithoutRightsTheRemedyIsTheRule) {
  node_.refuseToOpen(EACCES);
  EXPECT_EQ(
      refusalOf(node_.address()),
      "HID (/dev/hidraw-port) may not be opened; install the udev rule of Tandem and plug the "
      "device in again");
}

TEST(HidPort, SaysWhatCannotBeOpened) {
  HidAddress address;
  address.path = "/dev/hidraw-none";
  EXPECT_EQ(
      refusalOf(address),
      "HID (/dev/hidraw-none) cannot be opened (No such file or directory); see tandem device "
      "list");
  address.path = "/dev/null";
  EXPECT_EQ(refusalOf(address), "/dev/null is no HID device; give the path of a hidraw node");
  address = {};
  address.vendor = 0x16C0;
  address.product = 0xFFFF;
  EXPECT_EQ(refusalOf(address), "HID 16c0:ffff is not plugged in; see tandem device list");
}

TEST(HidPort, LooksForDevicesFromManyThreads) {
  const auto look = [] {
    for (int i = 0; i < 20; ++i) (void)findHid({0x16C0, 0xFFFF, 0, 0, -1, "", ""});
    return findHid({0x16C0, 0xFFFF, 0, 0, -1, "", ""}).size();
  };
  auto other = std::async(std::launch::async, look);
  EXPECT_EQ(look(), 0U);
  EXPECT_EQ(other.get(), 0U);
}

TEST(HidAddress, IsLikeWhatNamesNothingElse) {
  const HidAddress found{0x0403, 0x6030, 0xFF00, 1, 1, "/dev/hidraw3", "FT260"};
  EXPECT_TRUE(isLike(found, {}));
  EXPECT_TRUE(isLike(found, {0x0403, 0x6030, 0xFF00, 1, 1, "/dev/hidraw3", ""}));
  EXPECT_FALSE(isLike(found, {0x0404, 0, 0, 0, -1, "", ""}));
  EXPECT_FALSE(isLike(found, {0, 0x6031, 0, 0, -1, "", ""}));
  EXPECT_FALSE(isLike(found, {0, 0, 1, 0, -1, "", ""}));
  EXPECT_FALSE(isLike(found, {0, 0, 0, 2, -1, "", ""}));
  EXPECT_FALSE(isLike(found, {0, 0, 0, 0, 0, "", ""}));
  EXPECT_FALSE(isLike(found, {0, 0, 0, 0, -1, "/dev/hidraw4", ""}));
}

TEST(HidAddress, ReadsAsText) {
  EXPECT_EQ(toText(HidAddress{}), "any");
  EXPECT_EQ(toText(HidAddress{0, 0, 1, 8, -1, "", ""}), "usage page 0001 usage 0008");
  EXPECT_EQ(toText(HidAddress{0x0403, 0x6030, 1, 8, -1, "", "FT260"}), "0403:6030 FT260");
}

}  // namespace
}  // namespace tandem
