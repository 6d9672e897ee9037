#include "device/check_push.h"

#include <algorithm>

#include <fmt/format.h>

namespace tandem::demos {
namespace {

constexpr double kRest = 0.4, kRise = 0.3, kHold = 0.6;  // before, until and during a push [s]
constexpr double kLast = 0.1;                            // time in which places are averaged [s]
constexpr int kTries = 5;            // attempts at a push with gaps in its positions
constexpr double kForceShare = 0.1;  // allowed error of an emulated force
/// The way of an emulated grip is force over the hand's stiffness, minus up to 0.1 N of friction.
constexpr double kLeastWay = 0.75, kMostWay = 1.15, kMostAside = 0.25;

struct Mean {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  void add(const Vec3& value) {
    sum += value;
    ++count;
  }
  [[nodiscard]] Vec3 value() const { return count > 0 ? Vec3(sum / count) : Vec3(Vec3::Zero()); }
};

/// Empty if asked to end. A push with gaps in its positions has a `fault`.
std::optional<Push> push(LiveDevice& device, const char* where, const Vec3& asked_W,
                         const Pause& pause, const ShowPush& show) {
  Push result;
  result.where = where;
  result.asked_W = asked_W;
  Mean before, after, felt;
  bool has_gap = false;
  const double end = kRest + kRise + kHold;
  const auto make_force = [&](double t, const DeviceSample& sample) {
    has_gap |= !sample.valid || device.guard().is_cut;
    if (t > kRest - kLast && t <= kRest) before.add(sample.hip.p_W);
    const double share = std::clamp((t - kRest) / kRise, 0.0, 1.0);
    if (t > end - kLast) {
      after.add(sample.hip.p_W);
      if (device.emulated()) felt.add(device.map().settings().q_WD * device.emulated()->pushNow());
    }
    const double way = asked_W.normalized().dot(sample.hip.p_W - before.value());
    show(result, share * asked_W.norm(), t > kRest ? way : 0.0);
    return Vec3(share * asked_W);
  };
  if (!exchange(device, end, pause, make_force)) return std::nullopt;
  device.write(Vec3::Zero());
  result.moved_W = after.value() - before.value();
  if (device.emulated()) result.felt_W = felt.value();
  if (has_gap || before.count == 0 || after.count == 0) result.fault = "readings were missing";
  return result;
}

std::string findFault(const LiveDevice& device, const Push& push) {
  const double force = push.asked_W.norm();
  if ((*push.felt_W - push.asked_W).norm() > kForceShare * force)
    return fmt::format("the grip feels {:.2f} {:.2f} {:.2f} N", push.felt_W->x(), push.felt_W->y(),
                       push.felt_W->z());
  const double expected = device.map().settings().scale * force / EmulatedUser::kStiffness;
  const Vec3 direction_W = push.asked_W / force;
  const double along = direction_W.dot(push.moved_W);
  const double aside = (push.moved_W - along * direction_W).norm();
  if (along < kLeastWay * expected || along > kMostWay * expected || aside > kMostAside * expected)
    return fmt::format("the grip went {:.2f} mm along and {:.2f} mm aside instead of {:.2f} mm",
                       1e3 * along, 1e3 * aside, 1e3 * expected);
  return "";
}

}  // namespace

std::vector<Push> pushEachWay(LiveDevice& device, double force, const Pause& pause,
                              const ShowPush& show) {
  struct Way {
    const char* name;
    Vec3 direction_W;
  };
  const std::vector<Way> ways = {{"away", Vec3::UnitX()}, {"towards you", -Vec3::UnitX()},
                                 {"left", Vec3::UnitY()}, {"right", -Vec3::UnitY()},
                                 {"up", Vec3::UnitZ()},   {"down", -Vec3::UnitZ()}};
  std::vector<Push> pushes;
  for (const Way& way : ways) {
    std::optional<Push> done;
    for (int i = 0; i < kTries && (!done || !done->fault.empty()); ++i) {
      done = push(device, way.name, force * way.direction_W, pause, show);
      if (!done) return pushes;
    }
    if (done->fault.empty() && device.emulated()) done->fault = findFault(device, *done);
    pushes.push_back(*done);
  }
  return pushes;
}

}  // namespace tandem::demos
