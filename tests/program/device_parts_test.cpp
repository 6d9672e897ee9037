// Parts of `tandem device` that need no process: names of devices and switches, bars, axes.

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "tandem/falcon/gamepad_device.h"

#include "demos/program/device/bars.h"
#include "demos/program/device/device_spec.h"
#include "demos/program/device/device_switch.h"
#include "demos/program/device/user_axes.h"
#include "demos/program/terminal/usage_error.h"
#include "falcon/src/novint/falcon_frames.h"

namespace tandem::demos {
namespace {

using Kind = DeviceSpec::Kind;

TEST(DeviceSpec, ReadsEverySpellingAndWritesItBack) {
  const struct {
    const char* text;
    Kind kind;
    const char* place;
  } cases[] = {{"falcon", Kind::kFalconUsb, ""},
               {"falcon:FTPNM0FB", Kind::kFalconUsb, "FTPNM0FB"},
               {"falcon@/dev/ttyUSB0", Kind::kFalconTty, "/dev/ttyUSB0"},
               {"falcon@/dev/serial/by-id/a:b@c", Kind::kFalconTty, "/dev/serial/by-id/a:b@c"},
               {"falcon@ft260", Kind::kFalconFt260, ""},
               {"emulated", Kind::kEmulated, ""},
               {"simulated", Kind::kSimulated, ""},
               {"spacemouse", Kind::kSpaceMouse, ""},
               {"spacemouse:/dev/hidraw3", Kind::kSpaceMouse, "/dev/hidraw3"},
               {"hid", Kind::kRawHid, ""},
               {"hid:/dev/hidraw0", Kind::kRawHid, "/dev/hidraw0"},
               {"gamepad", Kind::kGamepad, ""},
               {"gamepad:/dev/input/event5", Kind::kGamepad, "/dev/input/event5"}};
  for (const auto& one : cases) {
    SCOPED_TRACE(one.text);
    const DeviceSpec spec = parseDeviceSpec(one.text);
    EXPECT_EQ(spec.kind, one.kind);
    EXPECT_EQ(spec.place, one.place);
    EXPECT_EQ(toText(spec), one.text);
  }
}

TEST(DeviceSpec, RefusesTheRest) {
  for (const char* text :
       {"", "Falcon", "falcon:", "falcon@", "falcon@ttyUSB0", "falcon@ft260x", "emulated:1",
        "simulated@/dev/x", "spacemouse:", "spacemouse:3", "hid@/dev/hidraw0", "hid:", "hid:/",
        "gamepad:", "gamepad:5", "gamepad@/dev/x", ":", "@/dev/ttyUSB0", "falcon "}) {
    SCOPED_TRACE(text);
    EXPECT_THROW((void)parseDeviceSpec(text), UsageError);
  }
}

TEST(DeviceSwitch, ReadsButtonsAndPedals) {
  EXPECT_EQ(parseSwitch("--clutch", "plus").button, kPlusButton);
  EXPECT_EQ(parseSwitch("--clutch", "forward").button, kForwardButton);
  EXPECT_EQ(parseSwitch("--clutch", "centre").button, kCentreButton);
  EXPECT_EQ(parseSwitch("--clutch", "minus").button, kMinusButton);
  EXPECT_EQ(parseSwitch("--grip", "south").button, kSouthButton);
  EXPECT_EQ(parseSwitch("--grip", "east").button, kEastButton);
  EXPECT_EQ(parseSwitch("--grip", "north").button, kNorthButton);
  EXPECT_EQ(parseSwitch("--grip", "west").button, kWestButton);
  EXPECT_EQ(parseSwitch("--grip", "left").button, kLeftShoulder);
  EXPECT_EQ(parseSwitch("--grip", "right").button, kRightShoulder);
  const SwitchSpec pedal = parseSwitch("--clutch", "hid:/dev/hidraw4,key,0,2,0x68");
  EXPECT_EQ(pedal.button, 0);
  EXPECT_EQ(pedal.path, "/dev/hidraw4");
  EXPECT_EQ(pedal.map.kind, HidSwitchKind::kKey);
  EXPECT_EQ(pedal.map.report, 0);
  EXPECT_EQ(pedal.map.byte, 2U);
  EXPECT_EQ(pedal.map.value, 0x68);
  EXPECT_EQ(parseSwitch("--clutch", "hid:/dev/hidraw4,bits,3,1,1").map.kind, HidSwitchKind::kBits);
  EXPECT_EQ(parseSwitch("--clutch", "hid:/dev/hidraw4,usage,2,1,205").map.value, 205);
}

TEST(DeviceSwitch, RefusesTheRest) {
  for (const char* text :
       {"", "foot", "hid:", "hid:/dev/hidraw4", "hid:/a,key,0,2", "hid:/a,key,0,2,3,4",
        "hid:/a,lever,0,2,3", "hid:/a,key,256,2,3", "hid:/a,key,0,65,3", "hid:/a,key,0,2,0x10000",
        "hid:/a,key,0,2,-1", "hid:/a,key,0,2,", "hid:/a,key,0,2,0x", "hid:a,key,0,2,3"}) {
    SCOPED_TRACE(text);
    EXPECT_THROW((void)parseSwitch("--clutch", text), UsageError);
  }
}

TEST(Bars, ShowValuesOfTheirRange) {
  EXPECT_EQ(makeLevel(0.0, 8.0, 4), "[    ]");
  EXPECT_EQ(makeLevel(4.0, 8.0, 4), "[##  ]");
  EXPECT_EQ(makeLevel(80.0, 8.0, 4), "[####]");
  EXPECT_EQ(makeLevel(-1.0, 8.0, 4), "[    ]");
  EXPECT_EQ(makeBar(0.0, 1.0, 3), "[   |   ]");
  EXPECT_EQ(makeBar(0.7, 1.0, 3), "[   |## ]");
  EXPECT_EQ(makeBar(-9.0, 1.0, 3), "[###|   ]");
  EXPECT_EQ(makeShare(0.0, 10), "");
  EXPECT_EQ(makeShare(0.001, 10), "#");
  EXPECT_EQ(makeShare(1.0, 10), "##########");
}

TEST(Bars, BearWhatIsNoNumber) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(makeLevel(nan, 8.0, 4), "[    ]");
  EXPECT_EQ(makeLevel(1.0, 0.0, 4), "[####]");
  EXPECT_EQ(makeLevel(1.0, inf, 4), "[    ]");
  EXPECT_EQ(makeBar(nan, 1.0, 3), "[   |   ]");
  EXPECT_EQ(makeBar(inf, 1.0, 3), "[   |###]");
}

// The axes are right-handed. Away from each user is towards the other, and up is up.
TEST(UserAxes, UsersLookAtEachOther) {
  const Vec3 right_D(1, 0, 0), up_D(0, 1, 0), to_user_D(0, 0, 1);
  const Quat first = computeUserAxes(Quat::Identity(), 0),
             second = computeUserAxes(Quat::Identity(), 1);
  EXPECT_LT((first * to_user_D - Vec3(-1, 0, 0)).norm(), 1e-15);
  EXPECT_LT((first * right_D - Vec3(0, -1, 0)).norm(), 1e-15);
  EXPECT_LT((first * up_D - Vec3(0, 0, 1)).norm(), 1e-15);
  EXPECT_LT((second * to_user_D - Vec3(1, 0, 0)).norm(), 1e-15);
  EXPECT_LT((second * right_D - Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_LT((second * up_D - Vec3(0, 0, 1)).norm(), 1e-15);
  // A turned scene turns its users.
  const Quat turned(Eigen::AngleAxisd(0.7, Vec3::UnitZ()));
  EXPECT_LT((computeUserAxes(turned, 0) * to_user_D - turned * Vec3(-1, 0, 0)).norm(), 1e-15);
}

}  // namespace
}  // namespace tandem::demos
