// Random worlds in which a host does at run time what hosts do. Nothing may break: every pose stays
// finite, no body falls through what stands, and none gets a speed that it would not have alone.

#include <cmath>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "support/fakes.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::FakeDevice;
using test::FakeLink;
using test::Random;

constexpr double kGravity = 9.81;
constexpr double kFastest = 40.0;  // no body is faster [m/s]
constexpr double kLowest = -0.3;   // no body that can stand is lower [m]
constexpr double kBetween = 0.25;  // time between two things that a host does [s]
constexpr double kDuration = 2.0;  // of a world [s]

/// A host's world with a site, and what was done to its bodies.
class GuestWorld {
 public:
  struct Guest {
    btRigidBody* body = nullptr;
    double mass = 0.0;
    bool is_shared = false, is_in_world = true, may_fall = false;
  };

  GuestWorld(std::uint64_t seed, PeerId self, double host_rate)
      : rig_(Vec3(0.0, 0.0, -kGravity)), device_(Vec3(0.0, 0.0, 0.2)), random_(seed) {
    settings_.self = self;
    settings_.contact = {1000.0, 5.0};
    settings_.coordination = {500.0, 10.0};
    settings_.host_step = 1.0 / host_rate;
    rig_.addBody(rig_.makeShape<btBoxShape>(btVector3(3, 3, btScalar(0.25))), 0.0,
                 Vec3(0.0, 0.0, -0.25));
    const int shared = 1 + random_.below(3);
    const int count = shared + 3 + random_.below(8);
    for (int i = 0; i < count; ++i) addGuest(i, i < shared);
    site_ = std::make_unique<Site>(settings_, rig_.world, device_);
    for (const Guest& guest : guests_)
      if (guest.is_shared) site_->share(*guest.body);
  }
  ~GuestWorld() {
    site_.reset();
    for (const Guest& guest : guests_)
      if (!guest.is_in_world) rig_.world.addRigidBody(guest.body);
  }

  [[nodiscard]] Site& site() { return *site_; }

  void step(double dt, double time) {
    // The hand presses on the bodies in turn.
    const Guest& target = guests_[static_cast<std::size_t>(time / 0.7) % guests_.size()];
    const Vec3 p_W = fromBullet(target.body->getCenterOfMassPosition());
    const Vec3 goal =
        p_W + Vec3(0.01 * std::sin(9.0 * time), 0.0, 0.03 + 0.02 * std::cos(5.0 * time));
    Vec3& hip = device_.sample.hip.p_W;
    const Vec3 way = goal - hip;
    hip += way * std::min(1.0, 0.5 * dt / std::max(way.norm(), 1e-9));
    rig_.step(dt);
  }

  /// Does one thing to a random body; its name.
  std::string act() {
    Guest& guest =
        guests_[static_cast<std::size_t>(random_.below(static_cast<int>(guests_.size())))];
    btRigidBody& body = *guest.body;
    switch (random_.below(15)) {
      case 0:
        guest.is_in_world ? rig_.world.removeRigidBody(&body) : rig_.world.addRigidBody(&body);
        guest.is_in_world = !guest.is_in_world;
        return "remove or put back";
      case 1:
        setMass(guest, body.getInvMass() > 0 ? 0.0 : guest.mass);
        return "pin or free";
      case 2:
        guest.mass *= random_.uniform(0.3, 3.0);
        setMass(guest, guest.mass);
        return "mass";
      case 3: {
        const auto scale = static_cast<btScalar>(random_.uniform(0.7, 1.4));
        body.getCollisionShape()->setLocalScaling(btVector3(scale, scale, scale));
        return "scaling";
      }
      case 4:
        body.setCollisionFlags(body.getCollisionFlags() ^ btCollisionObject::CF_KINEMATIC_OBJECT);
        return "kinematic on or off";
      case 5:
        body.setCollisionFlags(body.getCollisionFlags() ^
                               btCollisionObject::CF_NO_CONTACT_RESPONSE);
        guest.may_fall = true;
        return "contact response on or off";
      case 6:
        body.forceActivationState(
            body.getActivationState() == DISABLE_SIMULATION ? ACTIVE_TAG : DISABLE_SIMULATION);
        return "simulation on or off";
      case 7: {
        btTransform pose = body.getWorldTransform();
        pose.setOrigin(toBullet(drawPlace() + Vec3(0.0, 0.0, 0.3)));
        body.setWorldTransform(pose);
        body.setInterpolationWorldTransform(pose);
        body.setLinearVelocity(btVector3(0, 0, 0));
        return "teleport";
      }
      case 8:
        body.setAngularFactor(btVector3(0, 0, static_cast<btScalar>(random_.below(2))));
        return "angular factor";
      case 9:
        body.setLinearFactor(btVector3(1, static_cast<btScalar>(random_.below(2)), 1));
        return "linear factor";
      case 10:
        body.setFriction(static_cast<btScalar>(random_.uniform(0.0, 1.0)));
        body.setRestitution(static_cast<btScalar>(random_.uniform(0.0, 0.9)));
        body.setRollingFriction(static_cast<btScalar>(random_.uniform(0.0, 0.1)));
        return "friction and restitution";
      case 11:
        body.setDamping(static_cast<btScalar>(random_.uniform(0.0, 1.0)),
                        static_cast<btScalar>(random_.uniform(0.0, 1.0)));
        return "damping";
      case 12:
        body.activate(true);
        body.setLinearVelocity(toBullet(Vec3(drawPlace() * 5.0)));
        body.setAngularVelocity(toBullet(Vec3(drawPlace() * 50.0)));
        return "velocity";
      case 13:
        if (!guest.is_in_world) return "nothing";
        rig_.world.removeRigidBody(&body);
        rig_.world.addRigidBody(&body, 1 << random_.below(3), random_.below(8));
        guest.may_fall = true;
        return "group and mask";
      default:
        body.setGravity(btVector3(0, 0, static_cast<btScalar>(random_.uniform(-12.0, 2.0))));
        return "gravity";
    }
  }

  /// The first thing that broke, or nothing.
  [[nodiscard]] std::string findBroken() {
    for (std::size_t i = 0; i < guests_.size(); ++i) {
      const Guest& guest = guests_[i];
      const Vec3 p_W = fromBullet(guest.body->getCenterOfMassPosition());
      const Vec3 v_W = fromBullet(guest.body->getLinearVelocity());
      std::ostringstream text;
      text << "body " << i << (guest.is_shared ? " (shared)" : "") << " is at " << p_W.transpose()
           << ", " << v_W.transpose() << " m/s";
      if (!p_W.allFinite() || !v_W.allFinite()) return text.str();
      if (guest.may_fall || !guest.is_in_world) continue;
      const bool is_over_floor = p_W.head<2>().cwiseAbs().maxCoeff() < 2.5;
      if (is_over_floor && p_W.z() < kLowest && p_W.z() > -5.0) return text.str();
      if (v_W.norm() > kFastest && is_over_floor) return text.str();
    }
    if (site_->status() & (kStateNotFinite | kPacketRefused)) return "a status of the site";
    return {};
  }

 private:
  Vec3 drawPlace() {
    return {random_.uniform(-0.15, 0.15), random_.uniform(-0.15, 0.15), random_.uniform(0.0, 0.1)};
  }

  void addGuest(int index, bool is_shared) {
    const auto size = static_cast<btScalar>(random_.uniform(0.015, 0.03));
    btCollisionShape* shape = nullptr;
    switch (is_shared ? random_.below(5) : random_.below(7)) {
      case 0:
        shape = &rig_.makeShape<btSphereShape>(size);
        break;
      case 1:
        shape = &rig_.makeShape<btCapsuleShape>(size, size);
        break;
      case 2:
        shape = &rig_.makeShape<btCylinderShape>(btVector3(size, size, size));
        break;
      case 3:
        shape = &rig_.makeShape<btConeShape>(size, 2 * size);
        break;
      case 4:
      case 5:
        shape = &rig_.makeShape<btBoxShape>(btVector3(size, size, size));
        break;
      default: {
        auto& compound = rig_.makeShape<btCompoundShape>();
        btTransform at;
        at.setIdentity();
        compound.addChildShape(at, &rig_.makeShape<btBoxShape>(btVector3(size, size, size / 2)));
        at.setOrigin(btVector3(size, 0, 0));
        compound.addChildShape(at, &rig_.makeShape<btSphereShape>(size));
        shape = &compound;
      }
    }
    Guest guest;
    guest.mass = random_.uniform(0.1, 1.0);
    guest.is_shared = is_shared;
    const Vec3 p_W(0.08 * (index % 4) - 0.12, 0.08 * (index / 4) - 0.12, 0.06);
    guest.body = &rig_.addBody(*shape, guest.mass, p_W);
    guests_.push_back(guest);
  }

  void setMass(Guest& guest, double mass) {
    if (guest.is_in_world) rig_.world.removeRigidBody(guest.body);
    btVector3 inertia(0, 0, 0);
    if (mass > 0.0)
      guest.body->getCollisionShape()->calculateLocalInertia(static_cast<btScalar>(mass), inertia);
    guest.body->setMassProps(static_cast<btScalar>(mass), inertia);
    guest.body->updateInertiaTensor();
    rig_.world.addRigidBody(guest.body);
    guest.is_in_world = true;
  }

  BulletRig rig_;
  FakeDevice device_;
  Random random_;
  SiteSettings settings_;
  std::vector<Guest> guests_;
  std::unique_ptr<Site> site_;
};

/// Two hosts with the same bodies, which then do different things; what broke, or nothing.
std::string runWorlds(std::uint64_t seed) {
  Random random(seed);
  const double rate = random.below(2) == 0 ? 60.0 : 240.0;
  const double delay = random.uniform(0.0, 0.08);
  GuestWorld worlds[] = {{seed, PeerId{1}, rate}, {seed, PeerId{2}, rate}};
  FakeLink links[] = {FakeLink(256), FakeLink(256)};
  worlds[0].site().connect(PeerId{2}, links[0], Vec3(0.0, 0.0, 0.5));
  worlds[1].site().connect(PeerId{1}, links[1], Vec3(0.0, 0.0, 0.5));
  std::string done;
  double next = kBetween;
  for (int step = 0; step < kDuration * rate; ++step) {
    const double time = step / rate;
    if (time >= next) {
      next += kBetween;
      const int which = random.below(2);
      done += " | " + std::to_string(time) + " s, host " + std::to_string(which + 1) + ": " +
              worlds[which].act();
    }
    for (int i = 0; i < 2; ++i) {
      worlds[i].step(1.0 / rate, time);
      for (const StatePacket& packet : links[i].sent)
        links[1 - i].arrivals.push_back({packet, packet.time + delay});
      links[i].sent.clear();
      if (const std::string broken = worlds[i].findBroken(); !broken.empty())
        return "host " + std::to_string(i + 1) + " at " + std::to_string(time) + " s: " + broken +
               done;
    }
  }
  return {};
}

TEST(GuestWorlds, NothingBreaks) {
  const char* wanted = std::getenv("TANDEM_GUEST_WORLDS");
  const std::uint64_t count = wanted ? std::strtoull(wanted, nullptr, 10) : 30;
  const char* first = std::getenv("TANDEM_GUEST_SEED");
  const std::uint64_t start = first ? std::strtoull(first, nullptr, 10) : 20261123;
  int broken = 0;
  for (std::uint64_t seed = start; seed < start + count; ++seed) {
    const std::string what = runWorlds(seed);
    if (what.empty()) continue;
    ++broken;
    if (broken <= 10) ADD_FAILURE() << "seed " << seed << ": " << what;
  }
  EXPECT_EQ(broken, 0) << "of " << count << " worlds";
}

}  // namespace
}  // namespace tandem
