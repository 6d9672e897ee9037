#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "coordination/src/island/island.h"

namespace tandem::test {

/// Finds the contacts of boxes as features: corners of one box with the floor z = 0, or with a face
/// plane of another box.
class BoxWorld final : public ContactFinder {
 public:
  /// The four corners of a on its face towards b touch the face of b whose normal is its own axis.
  struct Pair {
    BodyIndex a, b;
    int axis;
    double corner_gaps[4] = {};  ///< constant errors of the four distances [m]
  };

  void lookAround(const std::vector<RigidState>& states, const std::vector<double>& reach,
                  std::vector<char>& awake, std::vector<char>& near) noexcept override {
    for (std::size_t again = 0; again < states.size(); ++again)
      for (const Pair& pair : pairs) {
        const auto a = static_cast<std::size_t>(pair.a), b = static_cast<std::size_t>(pair.b);
        awake[a] = awake[b] = awake[a] || awake[b];
      }
    for (std::size_t b = 0; b < states.size(); ++b) near[b] = awake[b] && reach[b] >= 0.0;
  }

  void find(const std::vector<RigidState>& states,
            std::vector<RigidContact>& contacts) noexcept override {
    if (has_floor)
      for (std::size_t a = 0; a < states.size(); ++a)
        for (int i = 0; i < 8; ++i) {
          const Vec3& half = half_extents[a];
          const Vec3 corner_B((i & 1) != 0 ? half.x() : -half.x(),
                              (i & 2) != 0 ? half.y() : -half.y(),
                              (i & 4) != 0 ? half.z() : -half.z());
          const Vec3 p_W = states[a].p_W + states[a].q_WB * corner_B;
          add(contacts, static_cast<BodyIndex>(a), kStanding, p_W, Vec3::UnitZ(), p_W.z());
        }
    for (const Pair& pair : pairs) {
      const RigidState& a = states[static_cast<std::size_t>(pair.a)];
      const RigidState& b = states[static_cast<std::size_t>(pair.b)];
      const Vec3& half_a = half_extents[static_cast<std::size_t>(pair.a)];
      const double half_b = half_extents[static_cast<std::size_t>(pair.b)][pair.axis];
      const Vec3 n_W = b.q_WB * Vec3::Unit(pair.axis);
      for (int i = 0; i < 4; ++i) {
        Vec3 corner_B = -half_a;
        if ((i & 1) != 0) corner_B[(pair.axis + 1) % 3] *= -1.0;
        if ((i & 2) != 0) corner_B[(pair.axis + 2) % 3] *= -1.0;
        const Vec3 p_W = a.p_W + a.q_WB * corner_B;
        add(contacts, pair.a, pair.b, p_W, n_W,
            n_W.dot(p_W - b.p_W) - half_b + pair.corner_gaps[i]);
      }
    }
  }

  std::vector<Vec3> half_extents;  ///< by body [m]
  std::vector<Pair> pairs;
  bool has_floor = true;
  double friction = 0.5, restitution = 0.0;

 private:
  void add(std::vector<RigidContact>& contacts, BodyIndex a, BodyIndex b, const Vec3& p_W,
           const Vec3& n_W, double distance) const noexcept {
    if (distance > 2e-3 || contacts.size() == contacts.capacity()) return;
    contacts.push_back({a, b, p_W, n_W, Vec3::Zero(), distance, friction, restitution, 0.0});
  }
};

/// An island of boxes with weight. A step near rigid contact lasts a whole tick.
struct BoxScene {
  static constexpr double kGravity = 9.81;  // [m/s^2]

  explicit BoxScene(double tick_length = 1e-3) : tick(tick_length), island(makeSettings(tick)) {}

  BodyIndex add(const Vec3& half_extents, double mass, const RigidState& start) {
    IslandBody body;
    body.shape = Box{half_extents};
    body.mass = mass;
    const Vec3 square = half_extents.cwiseAbs2();
    body.inertia_B = mass / 3.0 * (Vec3::Constant(square.sum()) - square);
    body.is_rigid = true;
    body.start = start;
    world.half_extents.push_back(half_extents);
    return island.addBody(body);
  }
  BodyIndex add(const Vec3& half_extents, double mass, const Vec3& p_W) {
    RigidState start;
    start.p_W = p_W;
    return add(half_extents, mass, start);
  }

  void prepare() {
    island.setContactFinder(&world);
    island.prepare();
    forces.assign(static_cast<std::size_t>(island.bodyCount()), Vec3::Zero());
  }

  /// Advances by a tick. The weight changes by its last bit each time, so that no body rests and
  /// each tick is solved.
  void advance() {
    is_odd = !is_odd;
    for (BodyIndex b = 0; b < island.bodyCount(); ++b) {
      const double weight = gravity * island.body(b).mass;
      Vec3 f_W = forces[static_cast<std::size_t>(b)];
      f_W.z() -= is_odd ? std::nextafter(weight, 1e9) : weight;
      island.setExternalWrench(b, f_W, Vec3::Zero());
    }
    const IslandCounters before = island.counters();
    island.advance(tick);
    const IslandCounters& after = island.counters();
    ++ticks;
    count(after.rigid_steps - before.rigid_steps, steps, most_steps);
    count(after.rigid_factorisations - before.rigid_factorisations, factorisations,
          most_factorisations);
    relaxations += after.rigid_relaxations - before.rigid_relaxations;
  }
  void run(double duration) {
    const auto count = static_cast<int>(std::lround(duration / tick));
    for (int i = 0; i < count; ++i) advance();
  }

  /// Kinetic energy, and potential energy above the floor [J].
  [[nodiscard]] double energy() const {
    double sum = 0.0;
    for (BodyIndex b = 0; b < island.bodyCount(); ++b) {
      const IslandBody& body = island.body(b);
      const RigidState& state = island.state(b);
      const Vec3 w_B = state.q_WB.conjugate() * state.w_W;
      sum += 0.5 * body.mass * state.v_W.squaredNorm() +
             0.5 * w_B.dot(body.inertia_B.cwiseProduct(w_B)) + body.mass * gravity * state.p_W.z();
    }
    return sum;
  }
  [[nodiscard]] bool isFinite() const {
    for (BodyIndex b = 0; b < island.bodyCount(); ++b) {
      const RigidState& s = island.state(b);
      if (!s.p_W.allFinite() || !s.v_W.allFinite() || !s.w_W.allFinite() ||
          !s.q_WB.coeffs().allFinite())
        return false;
    }
    return true;
  }
  [[nodiscard]] double stepsPerTick() const { return mean(steps); }
  [[nodiscard]] double factorisationsPerTick() const { return mean(factorisations); }

  double tick;  // [s]
  BoxWorld world;
  Island island;
  double gravity = kGravity;
  std::vector<Vec3> forces;  ///< beside the weight, by body [N]
  std::uint64_t ticks = 0, steps = 0, factorisations = 0, relaxations = 0;
  std::uint64_t most_steps = 0, most_factorisations = 0;  ///< in a tick

 private:
  static IslandSettings makeSettings(double tick) {
    IslandSettings settings;
    settings.haptic_period = tick;
    settings.inner_step = 0.25 * tick;  // the longest step is four of these
    return settings;
  }
  static void count(std::uint64_t now, std::uint64_t& sum, std::uint64_t& most) {
    sum += now;
    most = now > most ? now : most;
  }
  [[nodiscard]] double mean(std::uint64_t sum) const {
    return static_cast<double>(sum) / static_cast<double>(ticks);
  }

  bool is_odd = false;
};

/// Stacks cubes of half width `half` [m] on the floor, the first at the bottom.
inline void stack(BoxScene& scene, double half, const std::vector<double>& masses) {
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const auto level = static_cast<double>(2 * i + 1);
    const BodyIndex b = scene.add(Vec3::Constant(half), masses[i], Vec3(0, 0, level * half));
    if (b > 0) scene.world.pairs.push_back({b, b - 1, 2});
  }
}

}  // namespace tandem::test
