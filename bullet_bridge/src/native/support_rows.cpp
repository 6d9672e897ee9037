#include "native/support_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "tandem/bullet_bridge/convert.h"

#include "world/world_lookup.h"

namespace tandem {
namespace {

/// Bullet's solver makes as many times its sweeps while it has rows.
constexpr int kMoreSweeps = 5;

/// Sweeps of finish(), at most, and the impulse at which it ends [N s].
constexpr int kMostSweeps = 100;
constexpr double kSmallImpulse = 1e-12;

constexpr double kUnlimited = 1e18;

/// Change of velocity that a led support may resist: so many times that by which Bullet's own
/// contact pushes out of overlap, or at least that of a fall of two host steps.
constexpr double kMostSqueeze = 3.0;
constexpr double kFallOfTwoSteps = 2.0 * 9.81;  // by a step's length [m/s^2]

/// Speed by which a row yields in Bullet [m/s]: rounding must not push.
constexpr double kSlack = 64.0 * static_cast<double>(std::numeric_limits<btScalar>::epsilon());

void write(btScalar* axis, const Vec3& value) {
  for (int i = 0; i < 3; ++i) axis[i] = static_cast<btScalar>(value[i]);
}

/// The mean of contacts follows from them. A row for it lets few sweeps hold up a flat face at
/// once; its corners would take turns.
RigidContact computeMean(const RigidContact* contacts, std::size_t count) noexcept {
  RigidContact mean = contacts[0];
  for (std::size_t i = 1; i < count; ++i) {
    mean.p_W += contacts[i].p_W;
    mean.distance += contacts[i].distance;
  }
  const double share = 1.0 / static_cast<double>(count);
  mean.p_W *= share;
  mean.distance *= share;
  return mean;
}

/// Greatest impulse of a row [N s]. Nothing stops a led support. Where it jams a body against
/// joints or strangers, no impulse is enough, and sweeps would add to it as long as they go on.
double computeMost(const RigidContact& contact, const SupportLine& line, double correction,
                   double dt) noexcept {
  if (!line.a.body.is_led && !line.b.body.is_led) return kUnlimited;
  const double push_out = correction * std::max(0.0, -contact.distance) / dt;
  return std::max(kMostSqueeze * push_out, kFallOfTwoSteps * dt) / line.inverse_mass;
}

}  // namespace

/// A line in Bullet's form: J v >= target.
class SupportRows::Row final : public btTypedConstraint {
 public:
  /// Keeps references to the bodies.
  Row(btRigidBody& a, btRigidBody& b, const SupportLine& of, double limit)
      : btTypedConstraint(CONTACT_CONSTRAINT_TYPE, a, b), line(of), most(limit) {}

  void getInfo1(btConstraintInfo1* info) override {
    info->m_numConstraintRows = 1;
    info->nub = 5;
  }
  void getInfo2(btConstraintInfo2* info) override {
    const double speed = line.expect();
    const double slack = kSlack * (1.0 + std::abs(speed));
    write(info->m_J1linearAxis, line.along_W);
    write(info->m_J1angularAxis, line.a.arm_W.cross(line.along_W));
    write(info->m_J2linearAxis, -line.along_W);
    write(info->m_J2angularAxis, -line.b.arm_W.cross(line.along_W));
    info->m_constraintError[0] = static_cast<btScalar>(speed + line.free_speed - slack);
    info->m_damping = 1;
    info->cfm[0] = 0;
    info->m_lowerLimit[0] = 0;
    info->m_upperLimit[0] = static_cast<btScalar>(most);
  }
  void setParam(int, btScalar, int) override {}
  [[nodiscard]] btScalar getParam(int, int) const override { return 0; }

  SupportLine line;
  double most;  ///< greatest impulse [N s]
};

SupportRows::SupportRows(btDiscreteDynamicsWorld& host)
    : host_(host), ground_(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, nullptr)) {}

SupportRows::~SupportRows() { takeOut(); }

void SupportRows::clear() noexcept {
  last_faces_.swap(faces_);
  rows_.clear();
  frictions_.clear();
  faces_.clear();
}

/// Friction is solved when the joints are done: it would open them, and they would pull harder in
/// the next step.
bool SupportRows::hasJoint(const SupportBody& body) const noexcept {
  return body.bullet && std::binary_search(jointed_.begin(), jointed_.end(), &body.bullet->body());
}

void SupportRows::addFace(const RigidContact* contacts, std::size_t count, const SupportBody& a,
                          const SupportBody& b, double dt) {
  if (!a.bullet && !b.bullet) return;
  if (faces_.empty()) listJointed(host_, jointed_);
  const bool rubs = !hasJoint(a) && !hasJoint(b);
  const Vec3 n_W = contacts[0].n_W;
  const Vec3 s_W = n_W.unitOrthogonal(), t_W = n_W.cross(s_W);
  // A kinematic body carries along what stands on it.
  const bool is_carried = !a.bullet || (contacts[0].b >= 0 && !b.bullet);
  Face face{rows_.size(), 0, frictions_.size(), 0, contacts[0].friction, a.bullet, b.bullet};
  if (count > 1) addRow(computeMean(contacts, count), a, b, dt);
  for (std::size_t i = 0; i < count; ++i) {
    addRow(contacts[i], a, b, dt);
    if (!rubs) continue;
    for (const Vec3& along_W : {s_W, t_W}) {
      SupportLine line(a, b, contacts[i].p_W, along_W, 0.0);
      if (!is_carried) line.free_speed = along_W.dot(contacts[i].v_W) - line.expect();
      frictions_.push_back(line);
    }
  }
  face.end_row = rows_.size();
  face.end_friction = frictions_.size();
  face.friction /= static_cast<double>(count);
  faces_.push_back(face);
}

void SupportRows::addRow(const RigidContact& contact, const SupportBody& a, const SupportBody& b,
                         double dt) {
  const double closing = -std::max(0.0, contact.distance) / dt;
  SupportLine line(a, b, contact.p_W, contact.n_W, closing);
  // The island has resisted what it foresaw. Here it would push a neighbour once more.
  line.free_speed += std::min(0.0, line.foresee());
  if (!(line.inverse_mass > 0.0)) return;
  const auto correction = static_cast<double>(host_.getSolverInfo().m_erp2);
  rows_.push_back(std::make_unique<Row>(a.bullet ? a.bullet->body() : ground_,
                                        b.bullet ? b.bullet->body() : ground_, line,
                                        computeMost(contact, line, correction, dt)));
  host_.addConstraint(rows_.back().get());
  if (host_sweeps_ > 0) return;
  host_sweeps_ = host_.getSolverInfo().m_numIterations;
  host_.getSolverInfo().m_numIterations *= kMoreSweeps;
}

void SupportRows::takeOut() noexcept {
  if (host_sweeps_ == 0) return;
  int& sweeps = host_.getSolverInfo().m_numIterations;
  if (sweeps == kMoreSweeps * host_sweeps_) sweeps = host_sweeps_;
  host_sweeps_ = 0;
  // Last in, first out: the order of the host's own constraints stays.
  for (std::size_t i = rows_.size(); i-- > 0;) {
    host_.removeConstraint(rows_[i].get());
    rows_[i]->line.impulse = static_cast<double>(rows_[i]->getAppliedImpulse());
  }
}

void SupportRows::finish(double dt) noexcept {
  for (int count = 0; count < kMostSweeps; ++count) {
    double most = 0.0;
    for (const Face& face : faces_) most = std::max(most, sweep(face, dt));
    if (most < kSmallImpulse) break;
  }
  for (Face& face : faces_) {
    face.j_W = computeImpulse(face);
    face.lasting = computeLastingShare(face.j_W, findImpulseBefore(face));
  }
}

Vec3 SupportRows::computeImpulse(const Face& face) const noexcept {
  Vec3 j_W = Vec3::Zero();
  for (std::size_t i = face.first_row; i < face.end_row; ++i)
    j_W += rows_[i]->line.impulse * rows_[i]->line.along_W;
  for (std::size_t i = face.first_friction; i < face.end_friction; ++i)
    j_W += frictions_[i].impulse * frictions_[i].along_W;
  return j_W;
}

Vec3 SupportRows::findImpulseBefore(const Face& face) const noexcept {
  Vec3 j_W = Vec3::Zero();
  for (const Face& other : last_faces_)
    if (other.a == face.a && other.b == face.b) j_W += other.j_W;
  return j_W;
}

/// Returns the largest change of an impulse [N s].
double SupportRows::sweep(const Face& face, double dt) noexcept {
  double change = 0.0, pressed = 0.0;
  for (std::size_t i = face.first_row; i < face.end_row; ++i) {
    change = std::max(change, rows_[i]->line.improve(0.0, rows_[i]->most, dt));
    pressed += rows_[i]->line.impulse;
  }
  const double most = face.friction * pressed;
  for (std::size_t i = face.first_friction; i < face.end_friction; ++i)
    change = std::max(change, frictions_[i].improve(-most, most, dt));
  return change;
}

SupportRows::Given SupportRows::computeGiven(const HapticBody& body) const noexcept {
  Given given;
  for (const Face& face : faces_) {
    if (face.a != &body && face.b != &body) continue;
    Momentum sum;
    const auto add = [&](const SupportLine& line) {
      const Vec3 j_W = line.impulse * line.along_W;
      sum = sum + (face.a == &body ? line.a.computeMomentum(j_W) : line.b.computeMomentum(-j_W));
    };
    for (std::size_t i = face.first_row; i < face.end_row; ++i) add(rows_[i]->line);
    for (std::size_t i = face.first_friction; i < face.end_friction; ++i) add(frictions_[i]);
    given.all = given.all + sum;
    given.lasting = given.lasting + face.lasting * sum;
  }
  return given;
}

}  // namespace tandem
