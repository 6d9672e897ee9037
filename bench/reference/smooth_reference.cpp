#include "bench/reference/smooth_reference.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include "bench/scenes/touch_geometry.h"

namespace tandem::demos::bench {
namespace {

namespace odeint = boost::numeric::odeint;

/// Position and velocity of each tool, then of each body: six numbers each.
using Values = std::vector<double>;
using Stepper = odeint::runge_kutta_fehlberg78<Values>;

constexpr double kTolerance = 1e-13;
constexpr std::size_t kPerThing = 6;

PointState pointAt(const Values& x, std::size_t thing) {
  const double* s = x.data() + kPerThing * thing;
  return {{s[0], s[1], s[2]}, {s[3], s[4], s[5]}};
}

void put(Values& x, std::size_t thing, const Vec3& first, const Vec3& second) {
  for (int i = 0; i < 3; ++i) {
    x[kPerThing * thing + static_cast<std::size_t>(i)] = first[i];
    x[kPerThing * thing + 3 + static_cast<std::size_t>(i)] = second[i];
  }
}

/// Force of a contact if it could also pull.
struct Push {
  double overlap = 0.0;
  double force = 0.0;
  Vec3 normal_W = Vec3::Zero();
};

class SmoothScene {
 public:
  explicit SmoothScene(const BenchScene& scene);

  /// Advances to `until` with the targets of that time.
  void advance(double until, double max_step);
  void read(SceneState& state) const;

 private:
  [[nodiscard]] std::size_t bodyThing(std::size_t body) const { return scene_.tools.size() + body; }
  [[nodiscard]] bool& pushes(std::size_t tool, std::size_t body) {
    return pushing_[tool * scene_.bodies.size() + body];
  }
  [[nodiscard]] bool pushes(std::size_t tool, std::size_t body) const {
    return pushing_[tool * scene_.bodies.size() + body];
  }
  [[nodiscard]] Push computePush(const Values& x, std::size_t tool, std::size_t body) const;
  void computeRates(const Values& x, Values& dx) const;
  [[nodiscard]] bool isConsistent(const Values& x) const;
  void switchPairs(const Values& x);
  double findSwitch(const Values& from, double t, double step, Values& after);

  const BenchScene& scene_;
  double t_ = 0.0;
  Values x_;
  std::unique_ptr<bool[]> pushing_;  // tool by body
  std::vector<std::optional<PointState>> targets_;
};

SmoothScene::SmoothScene(const BenchScene& scene)
    : scene_(scene),
      x_(kPerThing * (scene.tools.size() + scene.bodies.size())),
      pushing_(std::make_unique<bool[]>(scene.tools.size() * scene.bodies.size())),
      targets_(scene.tools.size()) {
  for (std::size_t i = 0; i < scene.tools.size(); ++i)
    put(x_, i, scene.tools[i].start.p_W, scene.tools[i].start.v_W);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    put(x_, bodyThing(b), scene.bodies[b].start.p_W, scene.bodies[b].start.v_W);
  switchPairs(x_);
}

Push SmoothScene::computePush(const Values& x, std::size_t tool, std::size_t body) const {
  const PointState sphere = pointAt(x, tool);
  const PointState other = pointAt(x, bodyThing(body));
  RigidState pose = scene_.bodies[body].start;
  pose.p_W = other.p_W;
  const Touch touch =
      computeTouch(scene_.bodies[body], pose, sphere.p_W, scene_.tools[tool].radius);
  const double closing = -touch.normal_W.dot(sphere.v_W - other.v_W);
  const Vec3 arm = touch.p_W - other.p_W;
  if (!scene_.bodies[body].isStatic() && touch.overlap > 0.0 &&
      arm.cross(touch.normal_W).norm() > 1e-9)
    throw std::invalid_argument(scene_.name + ": the smooth reference does not turn bodies");
  return {touch.overlap,
          scene_.contact.stiffness * touch.overlap + scene_.contact.damping * closing,
          touch.normal_W};
}

void SmoothScene::computeRates(const Values& x, Values& dx) const {
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
    const bool moves = !scene_.bodies[b].isStatic();
    put(dx, bodyThing(b), pointAt(x, bodyThing(b)).v_W, moves ? scene_.gravity_W : Vec3::Zero());
  }
  for (std::size_t i = 0; i < scene_.tools.size(); ++i) {
    const BenchTool& tool = scene_.tools[i];
    const PointState at = pointAt(x, i);
    Vec3 f_W = tool.f_W;
    if (targets_[i])
      f_W += scene_.coupler.stiffness * (targets_[i]->p_W - at.p_W) +
             scene_.coupler.damping * (targets_[i]->v_W - at.v_W);
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
      if (!pushes(i, b)) continue;
      const Push push = computePush(x, i, b);
      f_W += push.force * push.normal_W;
      if (scene_.bodies[b].isStatic()) continue;
      const Vec3 a_W = -push.force / scene_.bodies[b].mass * push.normal_W;
      for (int k = 0; k < 3; ++k)
        dx[kPerThing * bodyThing(b) + 3 + static_cast<std::size_t>(k)] += a_W[k];
    }
    put(dx, i, at.v_W, f_W / tool.mass);
  }
}

bool SmoothScene::isConsistent(const Values& x) const {
  for (std::size_t i = 0; i < scene_.tools.size(); ++i)
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
      const Push push = computePush(x, i, b);
      if ((push.overlap > 0.0 && push.force > 0.0) != pushes(i, b)) return false;
    }
  return true;
}

void SmoothScene::switchPairs(const Values& x) {
  for (std::size_t i = 0; i < scene_.tools.size(); ++i)
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
      const Push push = computePush(x, i, b);
      pushes(i, b) = push.overlap > 0.0 && push.force > 0.0;
    }
}

/// Part of `step` at which the first pair switches; `after` is the state just after it.
double SmoothScene::findSwitch(const Values& from, double t, double step, Values& after) {
  Stepper stepper;
  const auto rates = [this](const Values& x, Values& dx, double) { computeRates(x, dx); };
  double before = 0.0, behind = step;
  for (;;) {
    const double middle = 0.5 * (before + behind);
    if (middle <= before || middle >= behind || behind - before < 1e-16) break;
    Values x = from;
    stepper.do_step(rates, x, t, middle);
    (isConsistent(x) ? before : behind) = middle;
  }
  after = from;
  stepper.do_step(rates, after, t, behind);
  return behind;
}

void SmoothScene::advance(double until, double max_step) {
  for (std::size_t i = 0; i < scene_.tools.size(); ++i)
    targets_[i] = heldTarget(scene_.tools[i], t_);
  const auto rates = [this](const Values& x, Values& dx, double) { computeRates(x, dx); };
  auto stepper = odeint::make_controlled<Stepper>(kTolerance, kTolerance);
  double proposal = max_step;
  while (until - t_ > 1e-15) {
    double step = std::min({proposal, max_step, until - t_});
    const double wanted = step;
    Values x = x_;
    double t = t_;
    if (stepper.try_step(rates, x, t, step) == odeint::fail) {
      proposal = step;
      continue;
    }
    proposal = std::max(step, wanted);
    if (isConsistent(x)) {
      x_ = x;
      t_ = t;
    } else {
      const Values from = x_;
      t_ += findSwitch(from, t_, wanted, x_);
      switchPairs(x_);
    }
  }
  t_ = until;
}

void SmoothScene::read(SceneState& state) const {
  for (std::size_t i = 0; i < scene_.tools.size(); ++i) state.tools[i] = pointAt(x_, i);
  for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
    const PointState at = pointAt(x_, bodyThing(b));
    state.bodies[b].p_W = at.p_W;
    state.bodies[b].v_W = at.v_W;
  }
}

}  // namespace

ReferenceRun runSmoothReference(const BenchScene& scene, double max_step) {
  SmoothScene motion(scene);
  ReferenceRun run;
  SceneState state = startState(scene);
  const auto count = static_cast<std::size_t>(std::llround(scene.duration * kGridRate));
  run.states.reserve(count + 1);
  run.states.push_back(state);
  for (std::size_t n = 1; n <= count; ++n) {
    motion.advance(static_cast<double>(n) / kGridRate, max_step);
    motion.read(state);
    run.states.push_back(state);
  }
  return run;
}

}  // namespace tandem::demos::bench
