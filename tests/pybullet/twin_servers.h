#pragma once

#include <algorithm>
#include <array>
#include <cstdio>

#include "plugin_host.h"
#include "stub_contacts.h"
#include "support/random.h"

namespace tandem::test {

inline constexpr double kAlong = 0.3;  // [m]
inline constexpr int kFloor = 0;       // number of a body

inline std::string toWord(const Vec3& v) {
  char text[96];
  (void)std::snprintf(text, sizeof text, "%.17g,%.17g,%.17g", v.x(), v.y(), v.z());
  return text;
}
inline std::string toWord(int number) { return std::to_string(number); }

inline b3::CollisionShapeData drawPiece(Random& random) {
  constexpr int kKinds[] = {b3::kBox, b3::kSphere, b3::kCapsule, b3::kCylinder};
  const int kind = kKinds[random.below(4)];
  // Boxes have edges, the others radii and lengths.
  const double scale = kind == b3::kBox ? 2.0 : 1.0;
  return makeStubShape(kind, scale * (Vec3::Constant(0.0325) + random.inCube(0.0175)));
}

inline StubBody drawBody(Random& random) {
  StubBody body;
  body.is_multibody = random.below(4) != 0;
  body.shape = {drawPiece(random)};
  if (body.is_multibody && random.below(4) == 0) {
    body.shape.push_back(drawPiece(random));
    body.shape[0].frame[0] = random.uniform(0.01, 0.03);
    body.shape[1].frame[0] = -body.shape[0].frame[0];
  }
  body.mass = random.logUniform(0.05, 2.0);
  body.inertia = computeStubInertia(body);
  body.friction = random.uniform(0.0, 1.0);
  body.restitution = random.below(3) == 0 ? random.uniform(0.0, 0.8) : 0.0;
  body.state.p_W = random.inCube(kAlong);
  body.state.p_W.z() = random.uniform(0.06, 0.3);
  return body;
}

/// Words for a shape that PyBullet does not tell.
inline std::string describeShape(const StubBody& body) {
  if (body.is_multibody) return "";
  const double* const d = body.shape.front().dimensions;
  const auto numbers = [](double a, double b) {
    return std::to_string(a) + "," + std::to_string(b);
  };
  switch (body.shape.front().geometry) {
    case b3::kBox:
      return " shape=box size=" + toWord(0.5 * Vec3(d));
    case b3::kSphere:
      return " shape=sphere size=" + std::to_string(d[0]);
    case b3::kCapsule:
      return " shape=capsule size=" + numbers(d[1], d[0]);
    default:
      return " shape=cylinder size=" + numbers(d[1], d[0]);
  }
}

/// Motion and weight over the floor, without spin [J].
inline double computeEnergy(const StubEngine& engine) {
  double sum = 0.0;
  for (const auto& [number, body] : engine.bodies) {
    const double height = std::max(0.0, body.state.p_W.z());
    sum += body.mass * (0.5 * body.state.v_W.squaredNorm() - engine.gravity.z() * height);
  }
  return sum;
}

/// Two servers with the same bodies on a floor, to which a host does the same: ours, with the
/// plugin, and a bare twin.
class TwinServers {
 public:
  PluginHost host;
  StubEngine& ours = host.engine;
  StubEngine twin;
  double longest_step = 0.0;  // internal one so far [s]

  explicit TwinServers(Random& random) {
    both([](StubEngine& engine) { engine.contacts = std::make_shared<StubContacts>(); });
    setGravity(-9.81);
    constexpr std::array<double, 4> kRates{50.0, 60.0, 120.0, 240.0};
    rate_ = kRates.at(static_cast<std::size_t>(random.below(4)));
    setStep(random);
    fill(random);
  }
  void step() {
    host.step();
    twin.step();
  }
  template <typename Do>
  void both(Do act) {
    for (StubEngine* engine : engines_) act(*engine);
  }
  void setGravity(double z) {
    both([z](StubEngine& engine) { engine.gravity = Vec3(0.0, 0.0, z); });
  }
  /// Internal steps stay alike: Bullet throws out bodies that sank in a floor in longer steps.
  void setStep(Random& random) {
    const int substeps = random.below(2) == 0 ? 0 : random.below(5);
    const double step = random.uniform(0.8, 1.2) / rate_;
    both([&](StubEngine& engine) {
      engine.time_step = step * std::max(1, substeps);
      engine.substeps = substeps;
    });
    longest_step = std::max(longest_step, step);
  }
  void addBody(Random& random) {
    const StubBody body = drawBody(random);
    both([&](StubEngine& engine) { engine.add(body); });
  }
  void reset(Random& random) {
    both([](StubEngine& engine) { engine.reset(); });
    fill(random);
  }
  void put(Random& random, int number) {
    RigidState state;
    state.p_W = random.inCube(kAlong);
    state.p_W.z() = random.uniform(0.06, 0.3);
    state.v_W = random.inCube(1.0);
    state.q_WB = random.rotation();
    both([&](StubEngine& engine) { engine.bodies.at(number).state = state; });
  }
  void change(Random& random, int number) {
    const double damping = random.uniform(0.0, 0.2), rolling = random.uniform(0.0, 0.01);
    const double friction = random.uniform(0.0, 1.0), restitution = random.uniform(0.0, 0.8);
    const int what = random.below(4);
    both([&](StubEngine& engine) {
      StubBody& body = engine.bodies.at(number);
      // PyBullet tells too little of maximal coordinates to know a body that gets all at once.
      const bool takes_all = body.is_multibody && what == 3;
      if (what == 0 || takes_all) body.linear_damping = body.angular_damping = damping;
      if (what == 1 || takes_all) body.friction = friction;
      if (what == 1 || takes_all) body.restitution = restitution;
      if (what == 2 || takes_all) body.rolling_friction = body.spinning_friction = rolling;
    });
  }
  /// A mass of 0 pins a body.
  void setMass(int number, double mass) {
    both([&](StubEngine& engine) {
      StubBody& body = engine.bodies.at(number);
      body.mass = mass;
      body.inertia = computeStubInertia(body);
      if (mass == 0.0) body.state.v_W = body.state.w_W = Vec3::Zero();
    });
  }
  void save() {
    for (std::size_t i = 0; i < engines_.size(); ++i) saved_.at(i) = engines_.at(i)->bodies;
  }
  /// PyBullet takes back states only, and only if it has the same bodies.
  void restore() {
    const auto is_same = [](const auto& a, const auto& b) {
      return a.first == b.first && a.second.serial == b.second.serial;
    };
    const auto& saved = saved_.back();
    if (!std::equal(saved.begin(), saved.end(), twin.bodies.begin(), twin.bodies.end(), is_same))
      return;
    for (std::size_t i = 0; i < engines_.size(); ++i)
      for (auto& [number, body] : engines_.at(i)->bodies)
        body.state = saved_.at(i).at(number).state;
  }

 private:
  void fill(Random& random) {
    both([](StubEngine& engine) { engine.add(makeStubFloor()); });
    for (int i = 2 + random.below(5); i-- > 0;) addBody(random);
  }

  double rate_;  // of internal steps, about [Hz]
  std::array<StubEngine*, 2> engines_{&ours, &twin};
  std::array<std::map<int, StubBody>, 2> saved_;
};

}  // namespace tandem::test
