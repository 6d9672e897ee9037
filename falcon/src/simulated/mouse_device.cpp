#include "tandem/falcon/mouse_device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "tandem/falcon/simulated_device.h"

#include "coordination/src/island/virtual_coupler.h"
#include "guard/force_limit.h"
#include "guard/latest_value.h"
#include "guard/passed_time.h"
#include "guard/settings_check.h"
#include "simulated/cursor_glide.h"

// clang-format off
//
//   window's thread   LatestValue   haptic thread
//
//   moveTo(p, t) -----> Target ---> CursorGlide --> MouseHand --> SimulatedDevice --> read(now)
//                                      c, c'          f_hand          x, x'   ^
//                                        |                              |     +------ write(f)
//   view() <----------- Shown <----------+------------------------------+
//
// clang-format on

namespace tandem {
namespace {

using falcon_detail::CursorGlide;
using falcon_detail::require;
using falcon_detail::shorten;

constexpr double kGlidePerInterval = 1.25;  // more than 1, so that the cursor rarely stops
constexpr double kLongestStep = 0.05;       // most time that passes for the handle in a read [s]
constexpr double kSubstep = 0.25e-3;        // longest sub-step of the simulated device then [s]

/// Vectors as plain numbers: those of Eigen do not promise to copy without throwing.
using Triple = std::array<double, 3>;
Triple toTriple(const Vec3& a) noexcept { return {a.x(), a.y(), a.z()}; }
Vec3 toVec3(const Triple& a) noexcept { return {a[0], a[1], a[2]}; }

/// A target on its way from the window's thread.
struct Target {
  Triple p_W{};
  double glide = 0.0;  ///< [s]
};

/// A MouseView on its way to the window's thread.
struct Shown {
  Triple handle_W{}, cursor_W{}, force_W{};
  bool is_slack = false;
};

/// Pulls the handle after the cursor by a spring-damper with a limit.
class MouseHand final : public Hand {
 public:
  MouseHand(const MouseSettings& settings, const CursorGlide& cursor)
      : gains_{settings.stiffness, settings.damping},
        limit_(settings.hand_force),
        cursor_(cursor) {}

  Vec3 computeForce(double t, const PointState& handle) const noexcept override {
    return shorten(computePull(t, handle), limit_);
  }

  /// True if the limit takes something from the force.
  [[nodiscard]] bool isAtLimit(double t, const PointState& handle) const noexcept {
    return computePull(t, handle).norm() > limit_;
  }

 private:
  [[nodiscard]] Vec3 computePull(double t, const PointState& handle) const noexcept {
    return computeCouplerForce(gains_, cursor_.at(t), handle);
  }

  CouplerGains gains_;
  double limit_;  ///< [N]
  const CursorGlide& cursor_;
};

/// Sub-steps take the hand's force as constant. The bounds leave a factor of 2 or more to
/// instability.
void requireStableHand(const MouseSettings& settings) {
  const double stiffest = settings.mass / (kSubstep * kSubstep);
  require(settings.stiffness > 0.0 && settings.stiffness <= stiffest, "stiffness of the mouse",
          settings.stiffness,
          "above 0 and at most " + falcon_detail::toText(stiffest) + " [N/m], for this mass");
  const double strongest = settings.mass / kSubstep;
  require(settings.damping >= 0.0 && settings.damping <= strongest, "damping of the mouse",
          settings.damping,
          "at least 0 and at most " + falcon_detail::toText(strongest) + " [N s/m], for this mass");
}

void requireGlides(const MouseSettings& settings) {
  require(std::isfinite(settings.shortest_glide) && settings.shortest_glide > 0.0,
          "shortest_glide of the mouse", settings.shortest_glide, "finite and above 0 [s]");
  require(
      std::isfinite(settings.longest_glide) && settings.longest_glide >= settings.shortest_glide,
      "longest_glide of the mouse", settings.longest_glide,
      "finite and not below shortest_glide [s]");
}

const MouseSettings& checked(const MouseSettings& settings) {
  require(std::isfinite(settings.mass) && settings.mass > 0.0, "mass of the mouse", settings.mass,
          "finite and above 0 [kg]");
  requireStableHand(settings);
  require(std::isfinite(settings.handle_damping) && settings.handle_damping >= 0.0,
          "handle_damping of the mouse", settings.handle_damping, "finite and at least 0 [N s/m]");
  require(std::isfinite(settings.hand_force) && settings.hand_force > 0.0,
          "hand_force of the mouse", settings.hand_force, "finite and above 0 [N]");
  require(std::isfinite(settings.max_force) && settings.max_force >= 0.0, "max_force of the mouse",
          settings.max_force, "finite and at least 0 [N]");
  requireGlides(settings);
  require(settings.start_W.allFinite(), "start_W of the mouse", settings.start_W, "finite [m]");
  require(std::isfinite(settings.workspace) && settings.workspace > 0.0, "workspace of the mouse",
          settings.workspace, "finite and above 0 [m]");
  return settings;
}

SimulatedDeviceSettings handleOf(const MouseSettings& settings) {
  SimulatedDeviceSettings handle;
  handle.mass = settings.mass;
  handle.damping = settings.handle_damping;
  handle.start_W = settings.start_W;
  handle.max_force = settings.max_force;
  return handle;
}

}  // namespace

/// All that the two threads share.
struct MouseDevice::Exchange {
  explicit Exchange(const Vec3& start_W) noexcept
      : view({toTriple(start_W), toTriple(start_W), {}, false}) {}

  LatestValue<Target> target;
  LatestValue<Shown> view;
};

/// The haptic thread's part: cursor, hand and handle.
class MouseDevice::Handle {
 public:
  Handle(const MouseSettings& settings, Exchange& exchange)
      : exchange_(exchange),
        max_force_(settings.max_force),
        cursor_(settings.start_W),
        hand_(settings, cursor_),
        device_(handleOf(settings), std::make_unique<MouseHand>(settings, cursor_)) {}

  [[nodiscard]] DeviceSample read(double now) noexcept {
    takeTarget();
    time_.pass(now);
    const DeviceSample sample = device_.read(time_.sum());
    publish();
    return sample;
  }

  void write(const Vec3& f_W) noexcept {
    force_W_ = shorten(f_W, max_force_);
    device_.write(force_W_);
    publish();
  }

 private:
  /// A new glide begins where the cursor was at the last read, so that it never jumps.
  void takeTarget() noexcept {
    if (!exchange_.target.isNew()) return;
    const Target& target = exchange_.target.read();
    cursor_.glideTo(toVec3(target.p_W), time_.sum(), target.glide);
  }

  void publish() noexcept {
    const PointState& handle = device_.handle();
    exchange_.view.write({toTriple(handle.p_W), toTriple(cursor_.at(time_.sum()).p_W),
                          toTriple(force_W_), hand_.isAtLimit(time_.sum(), handle)});
  }

  Exchange& exchange_;
  double max_force_;  ///< [N]
  CursorGlide cursor_;
  MouseHand hand_;  ///< equal to the device's own; both look at the cursor
  SimulatedDevice device_;
  Vec3 force_W_ = Vec3::Zero();
  falcon_detail::PassedTime time_{kLongestStep};  ///< that passes for the handle
};

MouseDevice::MouseDevice(const MouseSettings& settings)
    : reach_{checked(settings).start_W, settings.workspace},
      shortest_glide_(settings.shortest_glide),
      longest_glide_(settings.longest_glide),
      target_W_(settings.start_W),
      exchange_(std::make_unique<Exchange>(settings.start_W)),
      handle_(std::make_unique<Handle>(settings, *exchange_)) {
  capabilities_.name = "mouse";
  capabilities_.max_force = settings.max_force;
  capabilities_.workspace = Vec3::Constant(settings.workspace);
}

MouseDevice::~MouseDevice() = default;

bool MouseDevice::moveTo(const Vec3& target_W, double time) noexcept {
  if (is_held_ || !std::isfinite(time) || !reach_.contains(target_W)) return false;
  if (was_moved_ && time < time_) return false;
  const double glide =
      was_moved_ ? std::clamp(kGlidePerInterval * (time - time_), shortest_glide_, longest_glide_)
                 : longest_glide_;
  exchange_->target.write({toTriple(target_W), glide});
  target_W_ = target_W;
  time_ = time;
  was_moved_ = true;
  return true;
}

MouseView MouseDevice::view() noexcept {
  const Shown& shown = exchange_->view.read();
  return {toVec3(shown.handle_W), toVec3(shown.cursor_W), toVec3(shown.force_W), shown.is_slack};
}

const DeviceCapabilities& MouseDevice::capabilities() const noexcept { return capabilities_; }

DeviceSample MouseDevice::read(double now) noexcept { return handle_->read(now); }

void MouseDevice::write(const Vec3& f_W) noexcept { handle_->write(f_W); }

}  // namespace tandem
