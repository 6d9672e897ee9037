#include "tandem/falcon/space_mouse_device.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "guard/latest_value.h"
#include "guard/settings_check.h"
#include "hid/hid_stream.h"
#include "hid/rate_control.h"
#include "hid/space_mouse_report.h"

namespace tandem {
namespace {

/// Longest integration step [s]. After a longer pause the point continues without a jump.
constexpr double kLongestStep = 0.02;

double checkedSilence(double silence) {
  falcon_detail::require(std::isfinite(silence) && silence > 0.0, "silence of the SpaceMouse",
                         silence, "finite and above 0 [s]");
  return silence;
}

/// Converts the device's axes (y towards the user, z down) to the user's (y up, z towards the
/// user).
Vec3 toUser(const double* axes) noexcept { return {axes[0], -axes[2], axes[1]}; }

}  // namespace

/// Accumulates the reports on the reader's thread, and publishes the sum.
class SpaceMouseDevice::Client final : public HidClient {
 public:
  struct Sum {
    SpaceMouseState state;
    std::uint64_t count = 0;  ///< reports about the cap
    bool is_connected = false;
  };

  [[nodiscard]] bool takeReport(const std::uint8_t* report, std::size_t size,
                                double) noexcept override {
    const SpaceMouseNews news = takeSpaceMouseReport(report, size, sum_.state);
    if (news == SpaceMouseNews::kRefused) return false;
    if (news == SpaceMouseNews::kNothing) return true;
    if (news != SpaceMouseNews::kButtons) ++sum_.count;
    published_.write(sum_);
    return true;
  }

  void setConnected(bool is_connected) noexcept override {
    sum_.state = {};
    sum_.is_connected = is_connected;
    published_.write(sum_);
  }

  [[nodiscard]] const Sum& newest() noexcept { return published_.read(); }

 private:
  Sum sum_;
  LatestValue<Sum> published_;
};

SpaceMouseDevice::SpaceMouseDevice(HidOpener open, const SpaceMouseSettings& settings)
    : motion_(std::make_unique<RateControl>(settings.motion)),
      silence_(checkedSilence(settings.silence)),
      client_(std::make_unique<Client>()),
      stream_(
          std::make_unique<HidStream>(std::move(open), *client_, withoutWriting(settings.stream))) {
  capabilities_.name = "SpaceMouse";
  capabilities_.degrees_of_freedom = 0;
  capabilities_.max_force = 0.0;
  capabilities_.workspace = settings.motion.workspace;
}

SpaceMouseDevice::~SpaceMouseDevice() = default;

const DeviceCapabilities& SpaceMouseDevice::capabilities() const noexcept { return capabilities_; }

DeviceSample SpaceMouseDevice::read(double now) noexcept {
  const Client::Sum& sum = client_->newest();
  if (sum.count != heard_) {
    heard_ = sum.count;
    heard_at_ = now;
  }
  const double interval = was_read_ ? now - time_ : 0.0;
  time_ = now;
  was_read_ = true;
  if (!sum.is_connected) {
    motion_->stop();
    return {motion_->point(), false, motion_->wrist()};
  }
  const bool is_silent = now - heard_at_ > silence_;
  const double* axes = sum.state.axes.data();
  motion_->setDisplacement(is_silent ? Vec3(Vec3::Zero()) : toUser(axes),
                           is_silent ? Vec3(Vec3::Zero()) : toUser(axes + 3));
  motion_->advance(std::min(interval, kLongestStep));
  return {motion_->point(), true, motion_->wrist(), sum.state.buttons};
}

SpaceMouseStatus SpaceMouseDevice::status() {
  const Client::Sum& sum = client_->newest();
  return {sum.state, sum.is_connected, stream_->name(), stream_->trouble(), stream_->counters()};
}

}  // namespace tandem
