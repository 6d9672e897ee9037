#include "borrowed_body.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "gyroscope.h"
#include "refusal.h"

namespace tandem::pybullet {
namespace {

/// A new mark with each call. 1 - mark is 1 and v + mark v is v, in float as in double, and both
/// keep all 20 bits of the count.
double makeMark() {
  static std::atomic<unsigned> count{0};
  return 0x1p-100 * (1.0 + 0x1p-20 * (++count & 0xFFFFFU));
}

}  // namespace

BorrowedBody::BorrowedBody(const Engine& engine, int body) : body_(body) {
  const std::optional<BodyFacts> facts = engine.readFacts(body);
  if (!facts) {
    throw Refusal(kPyBulletSays,
                  "body " + std::to_string(body) + ": PyBullet has no rigid body of this number");
  }
  before_ = *facts;
  mass_ = before_.mass;
  inertia_ = Vec3(before_.inertia);
}

void BorrowedBody::borrow(const Engine& engine, double share) {
  mark_ = makeMark();
  engine.writeDamping(body_, mark_, mark_);
  if (share > 0.0) {
    mass_ *= share;
    inertia_ *= share;
    engine.writeMass(body_, mass_, inertia_.data());
    engine.letSleep(body_, false);
  }
}

bool BorrowedBody::isThere(const Engine& engine, std::string& notice) {
  const std::optional<BodyFacts> facts = engine.readFacts(body_);
  if (!facts) return false;
  const bool has_linear = facts->linear_damping == mark_;
  const bool has_angular = facts->angular_damping == mark_;
  if (!has_linear && !has_angular) return false;
  const std::string name = "body " + std::to_string(body_);
  if (!has_linear || !has_angular) {
    if (!has_linear) before_.linear_damping = facts->linear_damping;
    if (!has_angular) before_.angular_damping = facts->angular_damping;
    engine.writeDamping(body_, mark_, mark_);
    notice = name + ": damping was set while attached; it acts again after close";
  }
  if (std::abs(facts->mass - mass_) > 1e-6 * mass_) {
    engine.writeMass(body_, mass_, inertia_.data());
    notice =
        name + ": mass was set while attached, and has been put back; close before you change it";
  }
  return true;
}

bool BorrowedBody::giveBack(const Engine& engine) {
  std::string notice;
  if (!isThere(engine, notice)) return false;
  if (mass_ != before_.mass) engine.writeMass(body_, before_.mass, before_.inertia);
  engine.writeDamping(body_, before_.linear_damping, before_.angular_damping);
  // Of a multibody PyBullet does not tell whether it may sleep.
  if (!before_.is_multibody && before_.may_sleep) engine.letSleep(body_, true);
  return true;
}

void BorrowedBody::makeReadyToTurn(double step, TandemState& target) const {
  const GyroLaw law = before_.is_multibody ? GyroLaw::kExplicit : GyroLaw::kImplicit;
  const double* const q = target.orientation;
  const Vec3 w_W = computeVelocityBefore(law, inertia_, Quat(q[3], q[0], q[1], q[2]),
                                         Vec3(target.angular_velocity), step);
  std::copy_n(w_W.data(), 3, target.angular_velocity);
}

}  // namespace tandem::pybullet
