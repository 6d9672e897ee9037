#include "island/sleepers.h"

#include <algorithm>
#include <limits>

namespace tandem {
namespace {

/// A sleeper wakes while a sphere is still this far away, so that the sphere need not search at
/// every tick [m].
constexpr double kRoom = 1e-3;

/// Lower bound of the distance between a sphere and another body [m]; exact within `of_interest`.
double computeGap(const IslandModel& model, const States& states, BodyIndex sphere, BodyIndex other,
                  double of_interest) noexcept {
  const double way = (states[sphere].p_W - states[other].p_W).norm();
  const double between_balls =
      way - model.bodies[sphere].bounding_radius - model.bodies[other].bounding_radius;
  if (between_balls > of_interest) return between_balls;
  return computeTouchState(model, Touch{sphere, other, nullptr, {}}, states).geometry.gap;
}

}  // namespace

Sleepers::Sleepers(const IslandModel& model) {
  for (const IslandContact& contact : model.contacts) {
    const auto is_his = [&](const Watcher& w) { return w.sphere == contact.sphere; };
    auto watcher = std::find_if(watchers_.begin(), watchers_.end(), is_his);
    if (watcher == watchers_.end()) {
      watchers_.push_back({contact.sphere, {}});
      watcher = std::prev(watchers_.end());
    }
    watcher->partners.push_back(contact.other);
  }
}

void Sleepers::letSleep(IslandModel& model, const States& states,
                        const std::vector<double>& allowance, BodyIndex body) noexcept {
  for (const Watcher& watcher : watchers_) {
    if (watcher.sphere == body) return;
    if (model.bodies[watcher.sphere].is_ghost) continue;
    const auto& partners = watcher.partners;
    if (std::find(partners.begin(), partners.end(), body) == partners.end()) continue;
    const double near = allowance[watcher.sphere] + allowance[body] + 2.0 * kRoom;
    if (computeGap(model, states, watcher.sphere, body, near) < near) return;
  }
  model.bodies[body].is_asleep = true;
  model.is_listed = false;
  for (Watcher& watcher : watchers_) watcher.free_way = 0.0;
}

bool Sleepers::wakeNear(IslandModel& model, const States& states,
                        const std::vector<double>& allowance) noexcept {
  for (Watcher& watcher : watchers_) {
    if (model.bodies[watcher.sphere].is_ghost) continue;
    const double reach = allowance[watcher.sphere] + kWatchDistance;
    const double gone = (states[watcher.sphere].p_W - watcher.p_W).norm();
    if (!(gone + reach <= watcher.free_way)) look(model, states, reach, watcher);
  }
  if (model.is_listed) return false;
  model.listPresent();
  return true;
}

void Sleepers::look(IslandModel& model, const States& states, double reach,
                    Watcher& watcher) noexcept {
  watcher.p_W = states[watcher.sphere].p_W;
  watcher.free_way = std::numeric_limits<double>::infinity();
  for (const BodyIndex body : watcher.partners) {
    if (!model.bodies[body].is_asleep) continue;
    const double gap = computeGap(model, states, watcher.sphere, body, reach + kRoom);
    if (gap <= reach + kRoom)
      model.wake(body);
    else
      watcher.free_way = std::min(watcher.free_way, gap);
  }
}

}  // namespace tandem
