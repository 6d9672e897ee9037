#include "tandem/coordination/contact_outlook.h"

#include <cmath>
#include <stdexcept>

#include <unsupported/Eigen/MatrixFunctions>

#include "tandem/coordination/stability_advice.h"

#include "stability/loop_checks.h"
#include "stability/loop_model.h"

// One touch: the tick of LoopModel with contact that opens. Within a tick it may open and close
// kParts times. All that is heard of the other user rests at 0.

namespace tandem {
namespace {

constexpr int kParts = 8, kMoments = 16;
constexpr double kLongest = 1.0;       // of a touch [s]
constexpr double kHardlyRests = 0.99;  // restitution

LoopSettings open(LoopSettings settings) {
  settings.contact = {0.0, 0.0};
  return settings;
}

/// A hand and what it touches.
class Touch {
 public:
  explicit Touch(const LoopSettings& settings)
      : model_(stability::makeModeModel(settings, MotionMode::kDeaf)),
        system_(model_),
        period_(1.0 / settings.haptic_rate),
        closed_(makeMap(system_)),
        opened_(makeMap(
            stability::LoopSystem(stability::makeModeModel(open(settings), MotionMode::kDeaf)))) {}

  /// The hand comes at 1 m/s, and arrives `moment` of a tick after one.
  [[nodiscard]] double run(double moment) {
    values_ = Eigen::VectorXd::Zero(system_.size());
    values_(device()) = -moment * period_;
    values_(device() + 1) = 1.0;
    bool has_touched = false;
    for (double now = 0.0; now < kLongest; now += period_) {
      tick();
      has_touched |= isTouching();
      if (has_touched && !isTouching()) return -values_(device() + 1);
      for (int part = 0; part < kParts; ++part)
        values_ = (isTouching() ? closed_ : opened_) * values_;
    }
    return 0.0;
  }

 private:
  [[nodiscard]] Eigen::MatrixXd makeMap(const stability::LoopSystem& system) const {
    return (period_ / kParts * system.rates()).exp();
  }
  [[nodiscard]] int device() const { return system_.site(0).device; }

  /// The device is sampled; contact never pulls the hand.
  void tick() {
    const stability::SitePlaces& at = system_.site(0);
    values_.segment(at.hip, 2) = values_.segment(at.device, 2).eval();
    values_(at.force) = isTouching() ? std::min(0.0, system_.force(0).dot(values_)) : 0.0;
  }
  /// The hand is in the remote user's stand-in, and does not leave it faster than it follows.
  [[nodiscard]] bool isTouching() const {
    const stability::SitePlaces& at = system_.site(0);
    const double other = at.proxy >= 0 ? values_(at.proxy) : 0.0;
    return values_(at.hip) > other && system_.force(0).dot(values_) < 0.0;
  }

  stability::LoopModel model_;
  stability::LoopSystem system_;
  double period_;
  Eigen::MatrixXd closed_, opened_;
  Eigen::VectorXd values_;
};

}  // namespace

double computeRestitution(const LoopSettings& settings) {
  stability::checkLoop(settings);
  if (settings.has_object)
    throw std::invalid_argument("has_object = 1: a restitution is of users who touch each other");
  Touch touch(settings);
  double sum = 0.0;
  for (int i = 0; i < kMoments; ++i) sum += touch.run((i + 0.5) / kMoments);
  return sum / kMoments;
}

ContactOutlook computeOutlook(const LoopSettings& settings) {
  ContactOutlook outlook;
  outlook.restitution = computeRestitution(settings);
  outlook.comes_and_goes = computeWorstRate(settings) >= 0.0;
  outlook.period = 2.0 * settings.delay + 1.0 / settings.packet_rate;
  const double e = outlook.restitution;
  if (settings.stand_in == StandInKind::kHeld && e > 0.0 && e < kHardlyRests)
    outlook.changes = 1.0 + 2.0 * std::log(0.5) / std::log(e);
  return outlook;
}

}  // namespace tandem
