#include "novint/falcon_plant.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "guard/settings_check.h"

namespace tandem {
namespace {

constexpr double kStep = 0.00025;    // [s]
constexpr double kLongestGap = 1.0;  // longest simulated gap between calls; the rest is skipped [s]

const FalconPlantSettings& check(const FalconPlantSettings& s) {
  using falcon_detail::require;
  require(s.mass >= 0.01 && std::isfinite(s.mass), "mass", s.mass, "0.01 kg or more");
  require(s.viscous >= 0.0 && s.viscous <= 100.0, "viscous", s.viscous, "0 to 100");
  require(s.coulomb >= 0.0 && s.coulomb <= 10.0, "coulomb", s.coulomb, "0 to 10 N");
  require(s.gravity_D.allFinite(), "gravity_D", s.gravity_D, "finite");
  require(s.motors_per_torque > 0.0 && std::isfinite(s.motors_per_torque), "motors_per_torque",
          s.motors_per_torque, "above 0");
  require(s.half_extents.minCoeff() > 0.0, "half_extents", s.half_extents, "above 0");
  return s;
}

}  // namespace

FalconPlant::FalconPlant(const FalconPlantSettings& settings, std::unique_ptr<Hand> hand)
    : settings_(check(settings)), hand_(std::move(hand)) {
  const auto pose = kinematics_.computePose(settings.start_D);
  falcon_detail::require(pose.has_value(), "start_D", settings.start_D, "in reach of the legs");
  pose_ = *pose;
}

Vec3 FalconPlant::force() const noexcept {
  Vec3 torques;
  for (std::size_t i = 0; i < 3; ++i)
    torques[static_cast<Eigen::Index>(i)] = -motors_[i] / settings_.motors_per_torque;
  return pose_.dangles_dp.transpose() * torques;
}

/// Sum of all forces except Coulomb friction [N].
Vec3 FalconPlant::computePush(double t) const noexcept {
  const Vec3 from_centre = pose_.p_D - settings_.centre_D;
  Vec3 push = force() + settings_.mass * settings_.gravity_D - settings_.viscous * v_D_;
  if (hand_) push += hand_->computeForce(t, {from_centre, v_D_});
  const Vec3 inside =
      from_centre.cwiseMin(settings_.half_extents).cwiseMax(-settings_.half_extents);
  for (Eigen::Index i = 0; i < 3; ++i)
    if (const double over = from_centre[i] - inside[i]; over != 0.0)
      push[i] -= settings_.stop_stiffness * over + settings_.stop_damping * v_D_[i];
  return push;
}

void FalconPlant::step(double h) noexcept {
  if (held_D_) return;
  Vec3 v_D = v_D_ + h / settings_.mass * computePush(time_);
  // Coulomb friction slows the grip, at most to rest.
  const double speed = v_D.norm(), loss = h / settings_.mass * settings_.coulomb;
  v_D = speed > loss ? Vec3(v_D * (1.0 - loss / speed)) : Vec3(Vec3::Zero());
  v_D_ = v_D;
  moveTo(pose_.p_D + h * v_D);
}

/// Moves the grip; it stops where the legs do not reach.
void FalconPlant::moveTo(const Vec3& p_D) noexcept {
  if (const auto pose = kinematics_.computePose(p_D))
    pose_ = *pose;
  else
    v_D_.setZero();
}

void FalconPlant::advance(double now) noexcept {
  if (!has_time_) time_ = now;
  has_time_ = true;
  if (!(now > time_)) return;
  time_ = std::max(time_, now - kLongestGap);
  const int steps = static_cast<int>(std::ceil((now - time_) / kStep));
  const double h = (now - time_) / std::max(steps, 1);
  const double from = time_;
  for (int i = 0; i < steps; ++i) {
    time_ = from + i * h;
    step(h);
  }
  time_ = now;
}

bool FalconPlant::hold(const std::optional<Vec3>& p_D) noexcept {
  if (p_D && !kinematics_.computePose(*p_D)) return false;
  held_D_ = p_D;
  v_D_.setZero();
  if (p_D) moveTo(*p_D);
  return true;
}

}  // namespace tandem
