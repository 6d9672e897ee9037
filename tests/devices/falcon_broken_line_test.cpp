// A Falcon in real time whose line breaks: no fault leaves a force behind. Waits are for outcomes;
// their deadlines measure nothing.

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "tandem/falcon/byte_transport.h"
#include "tandem/falcon/emulated_falcon_port.h"
#include "tandem/falcon/falcon_device.h"
#include "tandem/falcon/monotonic_clock.h"

#include "devices/patient_falcon.h"
#include "falcon/src/novint/falcon_emulator.h"

namespace tandem {
namespace {

using namespace test;

/// A line that breaks: a number of reads or writes report that the device is gone.
struct Breaks {
  std::atomic<int> reads{0}, writes{0};
  std::atomic<bool> may_open{true};
};

class BreakingLine final : public ByteTransport {
 public:
  BreakingLine(FalconEmulator& emulator, Breaks& breaks)
      : line_(openEmulator(emulator)), breaks_(breaks) {}

  [[nodiscard]] const std::string& name() const noexcept override { return line_->name(); }
  [[nodiscard]] bool write(const std::uint8_t* bytes, std::size_t count) noexcept override {
    return !use(breaks_.writes) && line_->write(bytes, count);
  }
  [[nodiscard]] std::ptrdiff_t read(std::uint8_t* bytes, std::size_t room,
                                    double wait) noexcept override {
    return use(breaks_.reads) ? -1 : line_->read(bytes, room, wait);
  }
  [[nodiscard]] bool setLine(const SerialLine& line) noexcept override {
    return line_->setLine(line);
  }
  void purge() noexcept override { line_->purge(); }

 private:
  static bool use(std::atomic<int>& count) noexcept { return count > 0 && count-- > 0; }

  std::unique_ptr<ByteTransport> line_;
  Breaks& breaks_;
};

/// A device at an emulator in its own thread. The emulator may be read once the device is gone.
class FalconAtALineThatBreaks : public ::testing::Test {
 protected:
  FalconAtALineThatBreaks() : emulator_(readyDevice(), makeHoldingHand()) {}

  void start(double max_slew) {
    FalconSettings settings = patientSettings();
    settings.force.max_slew = max_slew;
    device_ = std::make_unique<FalconDevice>(settings, FirmwareImage{}, [this] {
      return breaks_.may_open ? std::make_unique<BreakingLine>(emulator_, breaks_) : nullptr;
    });
  }
  [[nodiscard]] bool waitUntil(const std::function<bool(const FalconStatus&)>& is_so,
                               const Vec3& push = Vec3(0.0, 25.0, 0.0)) {
    for (const double end = readMonotonicClock() + kLongest; readMonotonicClock() < end;
         sleepFor(0.001)) {
      device_->write(push);
      if (is_so(device_->status())) return true;
    }
    return false;
  }
  [[nodiscard]] bool waitUntilPushed() {
    return waitUntil([](const FalconStatus& s) { return s.force_D[1] > 7.99; });
  }
  /// Breaks the line of a device that pushes: so many of `failing` fail, and no new line opens.
  void expectRestAfterBreak(std::atomic<int>& failing, int count, double most_change) {
    start(2000.0);
    ASSERT_TRUE(waitUntilPushed());
    breaks_.may_open = false;
    failing = count;
    EXPECT_TRUE(waitUntil([](const FalconStatus& s) { return s.state == FalconState::kClosed; }));
    expectRest(most_change);
  }
  void expectRest(double most_change) {
    device_.reset();
    EXPECT_GT(emulator_.felt().most_force, 7.9);
    EXPECT_LT(emulator_.felt().most_change, most_change * 1.02);
    EXPECT_EQ(emulator_.command().motors, FalconMotors{});
    EXPECT_TRUE(emulator_.command().homes);
  }

  Breaks breaks_;
  FalconEmulator emulator_;
  std::unique_ptr<FalconDevice> device_;
};

TEST_F(FalconAtALineThatBreaks, ReadsThatFailLeaveNoForceBehind) {
  expectRestAfterBreak(breaks_.reads, 1000000, 2.0);
}

TEST_F(FalconAtALineThatBreaks, AWriteThatFailsOnceLeavesNoForceBehind) {
  expectRestAfterBreak(breaks_.writes, 1, 2.0);
}

// If only one frame gets through, it carries zero force, even if that is a single step.
TEST_F(FalconAtALineThatBreaks, TheLastFrameOfABadLineIsOneWithoutForce) {
  expectRestAfterBreak(breaks_.writes, 2, 8.0);
}

TEST_F(FalconAtALineThatBreaks, ItComesBack) {
  start(2000.0);
  for (const std::uint64_t times : {1U, 2U, 3U}) {
    ASSERT_TRUE(waitUntilPushed());
    EXPECT_EQ(device_->status().opened, times);
    breaks_.reads = 1;
    EXPECT_TRUE(waitUntil([times](const FalconStatus& s) { return s.opened > times; }));
  }
  expectRest(2.0);
}

TEST_F(FalconAtALineThatBreaks, ASlowStopIsAWholeOne) {
  start(50.0);
  ASSERT_TRUE(waitUntilPushed());
  expectRest(8.0 / 30.0);
  EXPECT_EQ(emulator_.command().lights, 0);
}

// The program that asked for the force may have ended since.
TEST_F(FalconAtALineThatBreaks, AForceAskedForWhileItWasClosedIsNotRendered) {
  breaks_.may_open = false;
  start(2000.0);
  device_->write(Vec3(0.0, 8.0, 0.0));
  breaks_.may_open = true;
  std::uint64_t ready_at = 0;
  for (const double end = readMonotonicClock() + kLongest; readMonotonicClock() < end;
       sleepFor(0.001)) {
    const FalconStatus& status = device_->status();
    if (ready_at == 0 && status.state == FalconState::kReady) ready_at = status.frames;
    if (ready_at > 0 && status.frames > ready_at + 200) break;
  }
  ASSERT_GT(ready_at, 0U);
  device_.reset();
  EXPECT_EQ(emulator_.felt().most_force, 0.0);
}

}  // namespace
}  // namespace tandem
