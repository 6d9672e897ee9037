// Worlds that a host of the C door builds, changes and takes apart at random times. Each has a twin
// without a site, to which the same is done.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "c_door/c_door_rig.h"
#include "support/drawn_hand.h"
#include "support/random.h"

namespace tandem {
namespace {

using namespace test;

constexpr double kGravity = 9.81, kFloorHalf = 0.5, kAlong = 0.3;  // [m/s^2, m, m]

/// TANDEM_DOOR_WORLDS asks for another number.
int countCases() {
  const char* wanted = std::getenv("TANDEM_DOOR_WORLDS");
  return wanted ? std::atoi(wanted) : 100;
}

/// A world of the door's with bodies of the host's.
class DoorWorld {
 public:
  DoorWorld() : world_(makeWorld()) {
    const double gravity[3] = {0.0, 0.0, -kGravity};
    ok(tandem_world_set_gravity(world_, gravity));
    TandemBodySettings floor = tandem_default_body_settings();
    floor.mass = 0.0;
    std::fill_n(floor.size, 3, kFloorHalf);
    floor.size[0] = floor.size[1] = 4.0;
    floor.start = makeState(Vec3(0.0, 0.0, -kFloorHalf));
    TandemBody body = TANDEM_NO_BODY;
    ok(tandem_world_add_body(world_, &floor, &body));
  }
  ~DoorWorld() { ok(tandem_world_destroy(world_)); }
  DoorWorld(const DoorWorld&) = delete;
  DoorWorld& operator=(const DoorWorld&) = delete;

  [[nodiscard]] TandemWorld* get() const { return world_; }
  void add(const TandemBodySettings& settings) {
    bodies_.emplace_back();
    ok(tandem_world_add_body(world_, &settings, &bodies_.back().id));
    bodies_.back().mass = settings.mass;
  }
  void remove(std::size_t index) {
    ok(tandem_world_remove_body(world_, bodies_[index].id));
    bodies_.erase(bodies_.begin() + static_cast<std::ptrdiff_t>(index));
  }
  void setDynamics(std::size_t index, const TandemDynamics& dynamics) {
    ok(tandem_world_set_dynamics(world_, bodies_[index].id, &dynamics));
    bodies_[index].mass = dynamics.mass;
  }
  void step(double dt) { ok(tandem_world_step(world_, dt, 0, 0.0)); }
  [[nodiscard]] std::size_t count() const { return bodies_.size(); }
  [[nodiscard]] TandemBody id(std::size_t index) const { return bodies_[index].id; }
  [[nodiscard]] TandemState state(std::size_t index) const {
    TandemState state{};
    ok(tandem_world_get_states(world_, 1, &bodies_[index].id, &state));
    return state;
  }
  /// Motion and weight over the floor, without spin [J].
  [[nodiscard]] double energy() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < count(); ++i) {
      const TandemState now = state(i);
      sum += bodies_[i].mass *
             (0.5 * toVec3(now.velocity).squaredNorm() + kGravity * std::max(0.0, now.position[2]));
    }
    return sum;
  }

 private:
  struct Body {
    TandemBody id = TANDEM_NO_BODY;
    double mass = 0.0;
  };
  TandemWorld* world_;
  std::vector<Body> bodies_;
};

TandemBodySettings drawBody(Random& random) {
  TandemBodySettings body = tandem_default_body_settings();
  constexpr TandemShapeKind kKinds[] = {TANDEM_BOX, TANDEM_SPHERE, TANDEM_CAPSULE, TANDEM_CYLINDER,
                                        TANDEM_CONE};
  body.shape = kKinds[random.below(5)];
  for (double& size : body.size) size = random.uniform(0.015, 0.05);
  body.mass = random.logUniform(0.05, 2.0);
  body.friction = random.uniform(0.0, 1.0);
  body.restitution = random.below(3) == 0 ? random.uniform(0.0, 0.8) : 0.0;
  const Vec3 p = random.inCube(kAlong);
  body.start = makeState(Vec3(p.x(), p.y(), random.uniform(0.06, 0.3)));
  return body;
}

/// A world with a site that comes and goes, and its twin.
class Case {
 public:
  explicit Case(std::uint64_t seed) : random_(seed) {
    rate_ = std::array<double, 4>{50.0, 60.0, 120.0, 240.0}.at(
        static_cast<std::size_t>(random_.below(4)));
    for (int i = 2 + random_.below(5); i-- > 0;) addBody(random_);
    ok(tandem_device_create_moved(hand_.position().data(), kAnyForce, &device_));
    open(random_);
  }
  ~Case() {
    close();
    ok(tandem_device_destroy(device_));
  }
  Case(const Case&) = delete;
  Case& operator=(const Case&) = delete;

  /// True if the hand has touched something.
  [[nodiscard]] bool hasFelt() const { return hand_.hasFelt(); }

  void run() {
    const int steps = static_cast<int>(rate_ * random_.uniform(0.3, 0.8));
    for (int step = 0; step < steps && !::testing::Test::HasFailure(); ++step) {
      if (random_.below(8) == 0) act();
      moveHand();
      ours_.step(1.0 / rate_);
      twin_.step(1.0 / rate_);
      judge(step);
    }
  }

 private:
  void addBody(Random& random) {
    const TandemBodySettings body = drawBody(random);
    ours_.add(body);
    twin_.add(body);
    objects_.push_back(-1);
    given_ += body.mass * kGravity * body.start.position[2];
  }
  void open(Random& random) {
    TandemSiteSettings settings = tandem_default_site_settings();
    settings.peers = 1 + random.below(2);
    ok(tandem_site_create(&settings, ours_.get(), device_, &site_));
    for (std::size_t i = 0; i < ours_.count(); ++i)
      if (random.below(3) == 0) share(i);
  }
  void close() {
    ok(tandem_site_destroy(site_));
    std::fill(objects_.begin(), objects_.end(), -1);
  }
  void share(std::size_t index) {
    std::uint32_t object = 0;
    ok(tandem_site_share(site_, ours_.id(index), 0.0, &object));
    objects_[index] = static_cast<int>(object);
  }
  void unshare(std::size_t index) {
    if (objects_[index] < 0) return;
    ok(tandem_site_unshare(site_, static_cast<std::uint32_t>(objects_[index])));
    objects_[index] = -1;
  }

  void act() {
    // Its own stream lets acts be left out one by one.
    Random random(static_cast<std::uint64_t>(random_.below(1 << 30)));
    const double before = ours_.energy();
    const auto index = static_cast<std::size_t>(random.below(static_cast<int>(ours_.count())));
    switch (random.below(8)) {
      case 0:
        if (ours_.count() < 10) addBody(random);
        return;
      case 1:
        if (ours_.count() < 3) return;
        unshare(index);
        ours_.remove(index);
        twin_.remove(index);
        objects_.erase(objects_.begin() + static_cast<std::ptrdiff_t>(index));
        break;
      case 2:
        put(random, index);
        break;
      case 3:
        change(random, index);
        break;
      case 4:
        push(random, index);
        break;
      case 5:
        unshare(index);
        break;
      case 6:
        if (objects_[index] < 0) share(index);
        break;
      default:
        close();
        open(random);
    }
    given_ += std::max(0.0, ours_.energy() - before);
  }
  void put(Random& random, std::size_t index) {
    TandemState state = makeState(random.inCube(kAlong), random.inCube(1.0));
    state.position[2] = random.uniform(0.06, 0.3);
    std::copy_n(random.rotation().coeffs().data(), 4, state.orientation);
    ok(tandem_world_set_state(ours_.get(), ours_.id(index), &state));
    ok(tandem_world_set_state(twin_.get(), twin_.id(index), &state));
  }
  void change(Random& random, std::size_t index) {
    TandemDynamics dynamics{};
    dynamics.mass = random.logUniform(0.05, 2.0);
    dynamics.friction = random.uniform(0.0, 1.0);
    dynamics.rolling_friction = random.below(2) == 0 ? 0.0 : random.uniform(0.0, 0.01);
    dynamics.spinning_friction = dynamics.rolling_friction;
    ours_.setDynamics(index, dynamics);
    twin_.setDynamics(index, dynamics);
  }
  void push(Random& random, std::size_t index) {
    const Vec3 force = random.inCube(10.0), torque = random.inCube(0.05);
    ok(tandem_world_apply_force(ours_.get(), ours_.id(index), force.data(), torque.data()));
    ok(tandem_world_apply_force(twin_.get(), twin_.id(index), force.data(), torque.data()));
    // The lightest body takes most: J^2 / (2 m) and v J, with all of the way that the force goes.
    const double speed = toVec3(ours_.state(index).velocity).norm();
    const double impulse = force.norm() / rate_;
    given_ += impulse * (speed + impulse / 0.025) + 0.1;
  }
  void moveHand() {
    double force[3];
    ok(tandem_device_get_force(device_, force));
    if (random_.below(10) == 0) {
      const auto index = static_cast<std::size_t>(random_.below(static_cast<int>(ours_.count())));
      hand_.aimAt(toVec3(ours_.state(index).position));
    }
    const Vec3 velocity = hand_.goOn(1.0 / rate_, toVec3(force));
    ok(tandem_device_move(device_, hand_.position().data(), velocity.data()));
    given_ += hand_.work();
  }

  void judge(int step) {
    const std::string place = "step " + std::to_string(step);
    for (std::size_t i = 0; i < ours_.count(); ++i) {
      const TandemState now = ours_.state(i), other = twin_.state(i);
      ASSERT_TRUE(toVec3(now.position).allFinite() && toVec3(now.velocity).allFinite() &&
                  toVec3(now.angular_velocity).allFinite())
          << place;
      fastest_fall_ = std::max(fastest_fall_, -now.velocity[2]);
      const bool is_over_floor = toVec3(now.position).cwiseAbs().head<2>().maxCoeff() < 3.9;
      if (is_over_floor && other.position[2] > 0.0) {
        // Bullet sees the floor at the end of a step.
        EXPECT_GT(now.position[2], -0.01 - fastest_fall_ / rate_) << place;
      }
    }
    EXPECT_LT(ours_.energy(), 1.5 * given_) << place;
    TandemReading reading{};
    ok(tandem_site_read(site_, &reading, 0, nullptr, 0, nullptr, nullptr));
    EXPECT_EQ(reading.status & ~std::uint32_t{TANDEM_STATUS_BODY_MISSING}, 0U) << place;
  }

  Random random_;
  double rate_;  // [Hz]
  DoorWorld ours_, twin_;
  TandemDevice* device_ = nullptr;
  TandemSite* site_ = nullptr;
  std::vector<int> objects_;  // by body; -1: not shared
  DrawnHand hand_{Vec3(0.0, 0.0, 0.1)};
  double fastest_fall_ = 0.0;  // [m/s]
  double given_ = 0.0;         // energy that acts and hands gave at most [J]
};

TEST(RandomDoorWorlds, NothingBreaks) {
  int felt = 0;
  for (int i = 0; i < countCases(); ++i) {
    const auto seed = static_cast<std::uint64_t>(4200 + i);
    SCOPED_TRACE("seed " + std::to_string(seed));
    Case one(seed);
    one.run();
    felt += one.hasFelt() ? 1 : 0;
    if (HasFailure()) return;
  }
  RecordProperty("felt", felt);
  EXPECT_GT(felt, countCases() / 4);
}

}  // namespace
}  // namespace tandem
