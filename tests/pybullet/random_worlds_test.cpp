// Worlds that a host of PyBullet's builds, changes and takes apart at random times. Each has a twin
// without the plugin, to which the same is done.

#include <algorithm>
#include <cstdlib>

#include "tandem/tandem.h"

#include "plugin_rig.h"
#include "support/drawn_hand.h"
#include "twin_servers.h"

namespace tandem::test {
namespace {

/// TANDEM_PYBULLET_WORLDS asks for another number.
int countCases() {
  const char* wanted = std::getenv("TANDEM_PYBULLET_WORLDS");
  return wanted ? std::atoi(wanted) : 100;
}

/// A server's world with a site that comes and goes, and its twin.
class Case {
 public:
  explicit Case(std::uint64_t seed) : random_(seed) {
    open(random_);
    given_ = computeEnergy(ours_);
  }

  /// True if the hand has touched something.
  [[nodiscard]] bool hasFelt() const { return hand_.hasFelt(); }

  void run() {
    for (double left = random_.uniform(0.3, 0.8); left > 0.0; left -= ours_.time_step) {
      if (::testing::Test::HasFailure()) return;
      while (random_.below(8) == 0) act();
      moveHand();
      servers_.step();
      awaited_.clear();
      ++step_;
      judge();
    }
    close();
  }

 private:
  void open(Random& random) {
    host_.command("device kind=moved start=" + toWord(hand_.position()));
    host_.command("site peers=" + toWord(1 + random.below(2)));
    if (random.below(3) > 0) takeObstacle(kFloor);
    for (const auto& [number, body] : twin_.bodies)
      if (random.below(3) == 0) share(random, number);
  }
  /// All is as the twin has it: the host did the same to both.
  void close() {
    host_.command("close");
    EXPECT_TRUE(ours_.without_contact.empty());
    for (const auto& [number, expected] : twin_.bodies) {
      const StubBody& body = ours_.bodies.at(number);
      const std::string place = "body " + toWord(number) + ", step " + toWord(step_);
      EXPECT_EQ(body.mass, expected.mass) << place;
      EXPECT_EQ(body.inertia, expected.inertia) << place;
      EXPECT_EQ(body.linear_damping, expected.linear_damping) << place;
      EXPECT_EQ(body.angular_damping, expected.angular_damping) << place;
      EXPECT_EQ(body.friction, expected.friction) << place;
      EXPECT_EQ(body.restitution, expected.restitution) << place;
      EXPECT_EQ(body.contact_threshold, expected.contact_threshold) << place;
    }
    shared_.clear(), obstacles_.clear(), free_objects_.clear();
    unsure_until_ = 0;
  }
  /// The plugin looks at one body per step. Until it has seen a change it may refuse the body.
  [[nodiscard]] bool isUnsure() const { return step_ < unsure_until_; }
  void beUnsure() { unsure_until_ = step_ + static_cast<int>(twin_.bodies.size()) + 12; }

  void share(Random& random, int number) {
    const StubBody& body = twin_.bodies.at(number);
    if (body.mass == 0.0 || shared_.count(number) > 0) return;
    std::string words = "share body=" + toWord(number) + describeShape(body);
    const bool is_again = !free_objects_.empty() && random.below(2) == 0;
    if (is_again) words += " object=" + toWord(free_objects_.back());
    const PluginAnswer answer = host_.ask(words);
    if (answer.status < 0) {
      EXPECT_TRUE(isUnsure()) << words << ": " << answer.bytes;
      return;
    }
    if (is_again) free_objects_.pop_back(), awaited_.insert(number);
    shared_[number] = answer.status;
  }
  void unshare(int number) {
    if (shared_.count(number) == 0) return;
    host_.command("unshare object=" + toWord(shared_.at(number)));
    forget(number);
  }
  void forget(int number) {
    if (shared_.count(number) > 0) free_objects_.push_back(shared_.at(number));
    shared_.erase(number);
    obstacles_.erase(number);
  }
  void takeObstacle(int number) {
    const StubBody& body = twin_.bodies.at(number);
    if (body.mass > 0.0 || obstacles_.count(number) > 0 || isUnsure()) return;
    host_.command("obstacle body=" + toWord(number) + describeShape(body));
    obstacles_.insert(number);
  }

  void act() {
    // Its own stream lets acts be left out one by one.
    Random random(static_cast<std::uint64_t>(random_.below(1 << 30)));
    const double before = computeEnergy(ours_);
    const auto place = random.below(static_cast<int>(twin_.bodies.size()) - 1);
    const int number = std::next(twin_.bodies.begin(), 1 + place)->first;
    doOne(random, number);
    given_ += std::max(0.0, computeEnergy(ours_) - before);
  }
  void doOne(Random& random, int number) {
    switch (random.below(14)) {
      case 0:
        if (twin_.bodies.size() < 10) servers_.addBody(random);
        return;
      case 1:
        return remove(random, number);
      case 2:
        return servers_.put(random, number);
      case 3:
        return change(random, number);
      case 4:
        return changeMass(random, number);
      case 5:
        return push(random, number);
      case 6:
        return unshare(number);
      case 7:
        return share(random, number);
      case 8:
        return takeObstacle(random.below(2) == 0 ? kFloor : number);
      case 9:
        return servers_.setGravity(random.below(3) == 0 ? 0.0 : -random.uniform(1.0, 20.0));
      case 10:
        return servers_.setStep(random);
      case 11:
        return random.below(2) == 0 ? servers_.save() : servers_.restore();
      case 12:
        return grabOrRelease(number);
      default:
        if (random.below(2) == 0) return reset(random);
        close();
        open(random);
    }
  }
  void remove(Random& random, int number) {
    if (twin_.bodies.size() < 4) return;
    servers_.both([&](StubEngine& engine) { engine.remove(number); });
    forget(number);
    beUnsure();
    if (random.below(2) == 0) servers_.addBody(random);  // takes its number
  }
  void reset(Random& random) {
    while (!shared_.empty()) forget(shared_.begin()->first);
    obstacles_.clear();
    servers_.reset(random);
    beUnsure();
  }
  void change(Random& random, int number) {
    const bool is_multibody = twin_.bodies.at(number).is_multibody;
    if (!is_multibody && isUnsure()) return;
    servers_.change(random, number);
    if (!is_multibody) beUnsure();
  }
  void changeMass(Random& random, int number) {
    const bool was_pinned = twin_.bodies.at(number).mass == 0.0;
    const double mass = random.below(3) == 0 ? 0.0 : random.logUniform(0.05, 2.0);
    if ((mass == 0.0) != was_pinned) {
      if (isUnsure()) return;
      forget(number);
      beUnsure();
    }
    servers_.setMass(number, mass);
  }
  void push(Random& random, int number) {
    const Vec3 impulse = ours_.time_step * random.inCube(10.0);
    servers_.both([&](StubEngine& engine) { engine.bodies.at(number).hit = impulse; });
    // The lightest body takes most: J^2 / (2 m) and v J.
    const double speed = ours_.bodies.at(number).state.v_W.norm();
    given_ += impulse.norm() * (speed + impulse.norm() / 0.025) + 0.1;
  }
  void grabOrRelease(int number) {
    host_.command("release");
    // An object that is shared again is held from the next step on.
    if (shared_.count(number) == 0 || awaited_.count(number) > 0) return;
    host_.command("grab object=" + toWord(shared_.at(number)));
    pressed_.insert(ours_.bodies.at(number).serial);
  }
  void moveHand() {
    const Vec3 force(host_.ask("force").doubles().data());
    if (random_.below(10) == 0) {
      const auto place = random_.below(static_cast<int>(ours_.bodies.size()));
      hand_.aimAt(std::next(ours_.bodies.begin(), place)->second.state.p_W);
    }
    const Vec3 velocity = hand_.goOn(ours_.time_step, force);
    host_.command("hand position=" + toWord(hand_.position()) + " velocity=" + toWord(velocity));
    given_ += hand_.work();
  }

  [[nodiscard]] bool touchInTandem(int a, int b) const {
    const auto is_attached = [&](int one) {
      return shared_.count(one) > 0 || obstacles_.count(one) > 0;
    };
    return is_attached(a) && is_attached(b);
  }
  /// True if the floor carries a body in one engine, and another body or the hand may press it in
  /// the other. They take turns, so a heavy one presses a light one into the floor.
  [[nodiscard]] bool isBetweenEngines(int number) const {
    const Vec3& at = ours_.bodies.at(number).state.p_W;
    const bool is_on_obstacle = touchInTandem(number, kFloor);
    if (shared_.count(number) > 0 && !is_on_obstacle && (hand_.position() - at).norm() < kNear)
      return true;
    for (const auto& [other, body] : ours_.bodies) {
      if (other == number || other == kFloor || (body.state.p_W - at).norm() > kNear) continue;
      if (touchInTandem(number, other) != is_on_obstacle) return true;
    }
    return false;
  }

  void judge() {
    const std::string place = "step " + toWord(step_);
    for (const auto& [number, body] : ours_.bodies) {
      const RigidState& now = body.state;
      ASSERT_TRUE(now.p_W.allFinite() && now.v_W.allFinite() && now.w_W.allFinite() &&
                  now.q_WB.coeffs().allFinite())
          << place;
      if (number == kFloor) continue;
      if (isBetweenEngines(number)) pressed_.insert(body.serial);
      fastest_fall_ = std::max(fastest_fall_, -now.v_W.z());
      // Bullet sees the floor at the end of a step, and loses spinning bodies in it below 100 Hz.
      const bool stands = twin_.bodies.at(number).state.p_W.z() > 0.0;
      if (servers_.longest_step < 0.01 && stands && pressed_.count(body.serial) == 0) {
        EXPECT_GT(now.p_W.z(), -0.01 - fastest_fall_ * servers_.longest_step)
            << place << ", body " << number;
      }
    }
    EXPECT_LT(computeEnergy(ours_), 1.5 * given_) << place;
    const std::vector<double> reading = host_.read();
    const auto status = static_cast<std::uint32_t>(reading.at(kStatus));
    EXPECT_EQ(status & ~std::uint32_t{TANDEM_STATUS_BODY_MISSING}, 0U) << place;
    EXPECT_EQ(reading.at(kHasEnded), 0.0) << place << ": " << host_.warnings();
  }

  static constexpr double kNear = 0.15;  // farther bodies do not touch [m]

  Random random_;
  TwinServers servers_{random_};
  PluginHost& host_ = servers_.host;
  StubEngine& ours_ = servers_.ours;
  StubEngine& twin_ = servers_.twin;
  std::map<int, int> shared_;  // objects by body
  std::set<int> obstacles_, awaited_;
  std::vector<int> free_objects_;  // had a body
  std::set<int> pressed_;          // serials of bodies that were between the engines
  DrawnHand hand_{Vec3(0.2, 0.2, 0.4)};
  int step_ = 0, unsure_until_ = 0;
  double fastest_fall_ = 0.0;  // [m/s]
  double given_ = 0.0;         // energy that acts and hands gave at most [J]
};

TEST(RandomPyBulletWorlds, NothingBreaks) {
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
  EXPECT_GT(felt, countCases() / 5);
}

}  // namespace
}  // namespace tandem::test
