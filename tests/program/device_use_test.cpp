// `tandem device`: missing devices and bad use.

#include <gtest/gtest.h>

#include "program/device_runs.h"
#include "program/tandem_program.h"

namespace tandem {
namespace {

using test::expectRefused;
using test::runEmulated;
using test::runTandem;

TEST(DeviceUse, RefusesWhatIsNotThere) {
  expectRefused(runTandem({"device", "info", "--device", "falcon@/dev/tandem-none"}), 1,
                {"/dev/tandem-none", "plugged in"});
  expectRefused(runTandem({"device", "info", "--device", "falcon:NO-SUCH-SERIAL"}), 1, {"device"});
  expectRefused(runTandem({"device", "info", "--device", "gamepad:/dev/input/tandem-none"}), 1,
                {"/dev/input/tandem-none", "No such file", "tandem device list"});
  expectRefused(runTandem({"device", "info", "--device", "gamepad:/dev/null"}), 1,
                {"/dev/null is no input device", "/dev/input/event"});
  expectRefused(runEmulated("info", {"--firmware", "/tandem/none.bin"}), 2,
                {"--firmware", "/tandem/none.bin"});
}

TEST(DeviceUse, RefusesBadUse) {
  expectRefused(runTandem({"device", "info", "--device", "nonsense"}), 2,
                {"nonsense", "emulated", "spacemouse", "gamepad"});
  expectRefused(runEmulated("info", {"--scale", "0"}), 2, {"--scale 0"});
  expectRefused(runEmulated("info", {"--max-force", "9"}), 2, {"--max-force 9", "at most 8"});
  expectRefused(runEmulated("info", {"--motors-per-torque", "-1"}), 2, {"--motors-per-torque -1"});
  expectRefused(runEmulated("info", {"--offset", "0", "0", "99"}), 2, {"--offset 99"});
  expectRefused(runEmulated("info", {"--clutch", "foot"}), 2, {"--clutch foot", "centre"});
  expectRefused(runEmulated("info", {"--grip", "foot"}), 2, {"--grip foot", "centre"});
  expectRefused(runEmulated("latency", {"--for", "0"}), 2, {"--for 0"});
  expectRefused(runEmulated("home", {"--wait", "-1"}), 2, {"--wait -1"});
  expectRefused(runEmulated("", {"--scenario", "/tandem/none.toml"}), 2, {"/tandem/none.toml"});
  expectRefused(runTandem({"device", "record"}), 2, {"file"});
  expectRefused(runTandem({"device", "dance"}), 2, {"dance"});
}

}  // namespace
}  // namespace tandem
