#include "borrowed_body.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "gyroscope.h"
#include "refusal.h"

namespace tandem::pybullet {
namespace {

/// Limit of btMultiBody for each axis of the world; PyBullet does not tell another [rad/s].
constexpr double kMostTurning = 100.0;

/// Makes a new mark. It is so small that 1 - mark is 1 and v + mark v is v, in float and double.
/// Both types keep all 20 bits of the count.
double makeMark() {
  static std::atomic<unsigned> count{0};
  return 0x1p-100 * (1.0 + 0x1p-20 * (1U + count++ % 0xFFFFFU));
}

/// Puts the count of `mark` in the low bits of `value`, a relative change below 6e-8. Returns the
/// mark itself for 0.
double addMark(double value, double mark) {
  const double count = mark * 0x1p100 - 1.0;  // 2^-20 to 1
  return value == 0.0 ? mark : value * (1.0 + 0x1p-24 * count);
}

void addLine(std::string& text, const std::string& line) {
  if (!text.empty()) text += '\n';
  text += line;
}

}  // namespace

BorrowedBody::BorrowedBody(const Engine& engine, int body) : body_(body) {
  const std::optional<BodyFacts> facts = engine.readFacts(body);
  if (!facts) {
    throw Refusal(kPyBulletSays,
                  "body " + std::to_string(body) + ": PyBullet has no rigid body of this number");
  }
  if (facts->is_soft) {
    throw Refusal(kPyBulletSays, "body " + std::to_string(body) +
                                     " is a soft body: Tandem can have rigid bodies only");
  }
  before_ = *facts;
  mass_ = before_.mass;
  inertia_ = Vec3(before_.inertia);
}

void BorrowedBody::borrow(const Engine& engine, double share, bool keeps_mass) {
  mark_ = makeMark();
  putMarks(engine);
  share_ = share;
  keeps_mass_ = keeps_mass;
  if (share > 0.0) {
    mass_ *= share;
    inertia_ *= share;
    engine.writeMass(body_, mass_, inertia_.data());
    engine.letSleep(body_, false);
  }
}

BorrowedBody::Marks BorrowedBody::findMarks(const BodyFacts& facts) const {
  return {facts.linear_damping == mark_, facts.angular_damping == mark_,
          facts.friction == addMark(before_.friction, mark_),
          before_.is_multibody && facts.restitution == addMark(before_.restitution, mark_),
          before_.contact_threshold > 0.0 &&
              facts.contact_threshold == addMark(before_.contact_threshold, mark_)};
}

void BorrowedBody::putMarks(const Engine& engine) const {
  engine.writeDamping(body_, mark_, mark_);
  engine.writeFriction(body_, addMark(before_.friction, mark_));
  if (before_.is_multibody) {
    engine.writeRestitution(body_, addMark(before_.restitution, mark_));
  }
  // A mark in place of 0 would let contacts act only where bodies overlap.
  if (before_.contact_threshold > 0.0) {
    engine.writeContactThreshold(body_, addMark(before_.contact_threshold, mark_));
  }
}

/// Keeps the user's new values behind new marks. True if the surface is another.
bool BorrowedBody::renewMarks(const Engine& engine, const BodyFacts& facts, const Marks& has,
                              std::string& notice) {
  const bool has_damping = has.linear_damping && has.angular_damping;
  const bool has_surface = has.friction && (has.restitution || !before_.is_multibody);
  const bool has_threshold = has.contact_threshold || !(before_.contact_threshold > 0.0);
  if (has_damping && has_surface && has_threshold) return false;
  if (!has_damping) {
    addLine(notice, "body " + std::to_string(body_) +
                        ": damping was set while attached; it acts again after close");
  }
  if (!has.linear_damping) before_.linear_damping = facts.linear_damping;
  if (!has.angular_damping) before_.angular_damping = facts.angular_damping;
  if (!has.friction) before_.friction = facts.friction;
  if (!has.restitution) before_.restitution = facts.restitution;
  if (!has_threshold) before_.contact_threshold = facts.contact_threshold;
  putMarks(engine);
  return !has_surface;
}

/// The user sets the whole mass and inertia. PyBullet resets the inertia with the mass.
bool BorrowedBody::followMass(const Engine& engine, const BodyFacts& facts, std::string& notice) {
  constexpr double kRounding = 1e-6;
  if (share_ == 0.0) return false;
  const bool is_other_mass = std::abs(facts.mass - mass_) > kRounding * mass_;
  const Vec3 inertia(facts.inertia);
  const bool is_other_inertia = !((inertia - inertia_).norm() <= kRounding * inertia_.norm());
  if (!is_other_mass && !is_other_inertia) return false;
  if (keeps_mass_) {
    engine.writeMass(body_, mass_, inertia_.data());
    addLine(notice, "body " + std::to_string(body_) +
                        ": mass was set while it shows a proxy, and has been put back");
    return false;
  }
  if (is_other_mass) before_.mass = facts.mass;
  std::copy_n(facts.inertia, 3, before_.inertia);
  mass_ = share_ * before_.mass;
  inertia_ = share_ * inertia;
  engine.writeMass(body_, mass_, inertia_.data());
  return true;
}

bool BorrowedBody::followRolling(const BodyFacts& facts, std::string& notice) {
  if (facts.has_soft_contact && !before_.has_soft_contact) {
    addLine(notice, "body " + std::to_string(body_) +
                        ": contact stiffness was set while attached; in Tandem it does not act");
  }
  before_.has_soft_contact = facts.has_soft_contact;
  const bool is_same = facts.rolling_friction == before_.rolling_friction &&
                       facts.spinning_friction == before_.spinning_friction;
  before_.rolling_friction = facts.rolling_friction;
  before_.spinning_friction = facts.spinning_friction;
  return !is_same;
}

BorrowedBody::Presence BorrowedBody::look(const Engine& engine, std::string& notice) {
  const std::optional<BodyFacts> facts = engine.readFacts(body_);
  if (!facts) return Presence::kRemoved;
  const Marks has = findMarks(*facts);
  if (!has.linear_damping && !has.angular_damping && !has.friction && !has.restitution &&
      !has.contact_threshold) {
    return Presence::kUnmarked;
  }
  bool is_changed = renewMarks(engine, *facts, has, notice);
  is_changed |= followRolling(*facts, notice);
  if (mass_ > 0.0 && !(facts->mass > 0.0)) return Presence::kPinned;
  if (mass_ == 0.0 && facts->mass > 0.0) return Presence::kFreed;
  is_changed |= followMass(engine, *facts, notice);
  return is_changed ? Presence::kChanged : Presence::kSame;
}

bool BorrowedBody::giveBack(const Engine& engine) {
  std::string notice;
  const Presence presence = look(engine, notice);
  if (presence == Presence::kRemoved || presence == Presence::kUnmarked) return false;
  const bool keeps_mass = presence == Presence::kPinned || presence == Presence::kFreed;
  if (!keeps_mass && mass_ != before_.mass) {
    engine.writeMass(body_, before_.mass, before_.inertia);
  }
  engine.writeDamping(body_, before_.linear_damping, before_.angular_damping);
  engine.writeFriction(body_, before_.friction);
  if (before_.is_multibody) engine.writeRestitution(body_, before_.restitution);
  if (before_.contact_threshold > 0.0) {
    engine.writeContactThreshold(body_, before_.contact_threshold);
  }
  // PyBullet does not tell whether a multibody may sleep.
  if (!before_.is_multibody && before_.may_sleep) engine.letSleep(body_, true);
  return true;
}

void BorrowedBody::makeReadyToTurn(double step, TandemState& target) {
  const GyroLaw law = before_.is_multibody ? GyroLaw::kExplicit : GyroLaw::kImplicit;
  const double* const q = target.orientation;
  const Quat R_WB(q[3], q[0], q[1], q[2]);
  const Vec3 wanted_W(target.angular_velocity);
  const Vec3 w_W = computeVelocityBefore(law, inertia_, R_WB, wanted_W, step);
  Vec3 after_W = applyGyroLaw(law, inertia_, R_WB, w_W, step);
  if (before_.is_multibody) after_W = after_W.cwiseMax(-kMostTurning).cwiseMin(kMostTurning);
  turn_ = after_W - wanted_W;
  std::copy_n(w_W.data(), 3, target.angular_velocity);
}

void BorrowedBody::leaveOutTurn(TandemState& after) const {
  for (int i = 0; i < 3; ++i) after.angular_velocity[i] -= turn_[i];
}

}  // namespace tandem::pybullet
