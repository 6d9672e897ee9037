#include "bench/stress/paper_check.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "bench/reference/paper_reference.h"

namespace tandem::demos::bench {
namespace {

/// Number of copies of the cube.
constexpr double kPeers = 2.0;

/// Smallest displacement that a difference is divided by [m].
constexpr double kLeastDisplacement = 1e-6;

reference::PaperParameters makeParameters(const StressCase& one) {
  if (one.kind != StressKind::kPaper)
    throw std::invalid_argument("only cases of kind paper have a reference");
  reference::PaperParameters p;
  const bool has_cube = !one.bodies.empty();
  p.experiment = has_cube ? reference::Experiment::kCooperativeManipulation
                          : reference::Experiment::kUserContact;
  p.hand_force_1 = one.users[0].hand_W.x();
  p.hand_force_2 = one.users[1].hand_W.x();
  p.contact = {one.contact.stiffness, one.contact.damping};
  p.coordination = {one.coordination.stiffness, one.coordination.damping};
  if (has_cube) p.object_mass = kPeers * one.bodies.front().mass;
  p.proxy_mass = one.proxy_mass;
  p.proxy_damping = one.proxy_damping;
  p.device_damping = one.users[0].device_damping;
  p.sampling.haptic_rate = one.haptic_rate;
  p.sampling.packet_rate = one.packet_rate;
  p.sampling.delay = one.network.delay;
  p.sampling.duration = one.duration;
  // The step is a hundredth of a radian of the fastest oscillation, and of the fastest decay's
  // time.
  const double lightest =
      has_cube ? std::min(one.proxy_mass, one.bodies.front().mass) : one.proxy_mass;
  const double stiffness = 2.0 * one.contact.stiffness + one.coordination.stiffness;
  const double damping = 2.0 * one.contact.damping + one.coordination.damping + one.proxy_damping;
  p.step = std::min({2e-6, 0.01 / std::sqrt(stiffness / lightest), 0.05 * lightest / damping});
  p.step = std::max(p.step, 5e-8);
  return p;
}

}  // namespace

PaperCheck::PaperCheck(const StressCase& one) {
  const reference::PaperResult result = reference::runPaperModel(makeParameters(one));
  int changes = 0;
  bool touching1 = false, touching2 = false;
  for (const reference::PaperRow& row : result.rows) {
    changes += ((row.force_1 != 0.0) != touching1) + ((row.force_2 != 0.0) != touching2);
    touching1 = row.force_1 != 0.0;
    touching2 = row.force_2 != 0.0;
    if (changes > kMostChanges || !std::isfinite(row.x1) || !std::isfinite(row.x2)) break;
    rows_.push_back({row.x1, row.x2});
  }
}

void PaperCheck::compare(std::uint64_t tick, double x1, double x2) {
  if (tick >= rows_.size()) return;
  const Row& row = rows_[tick];
  largest_ = std::max({largest_, std::abs(row.x1), std::abs(row.x2), kLeastDisplacement});
  worst_ = std::max({worst_, std::abs(x1 - row.x1) / largest_, std::abs(x2 - row.x2) / largest_});
}

}  // namespace tandem::demos::bench
