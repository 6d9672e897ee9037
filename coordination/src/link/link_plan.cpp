#include "tandem/coordination/link_plan.h"

#include <cmath>
#include <limits>

#include "bad_value.h"

namespace tandem {
namespace {

template <typename Value>
void changeTo(Value& value, const std::optional<Value>& change) noexcept {
  if (change) value = *change;
}

void apply(LinkSettings& settings, const LinkChange& change) noexcept {
  changeTo(settings.impairments.delay, change.delay);
  changeTo(settings.impairments.jitter, change.jitter);
  changeTo(settings.impairments.loss, change.loss);
  changeTo(settings.impairments.duplicate, change.duplicate);
  changeTo(settings.impairments.reorder, change.reorder);
  changeTo(settings.corrupt, change.corrupt);
  changeTo(settings.keep_order, change.keep_order);
  changeTo(settings.outage, change.outage);
  changeTo(settings.cut, change.cut);
}

}  // namespace

ChannelConditions conditionsOf(const LinkSettings& settings, Direction direction) noexcept {
  const LinkCut own = direction == Direction::kForward ? LinkCut::kForward : LinkCut::kBack;
  return {settings.impairments, settings.corrupt, settings.keep_order,
          settings.outage || settings.cut == own};
}

LinkPlan::LinkPlan(const LinkSettings& start, std::vector<LinkChange> changes)
    : settings_(start), changes_(std::move(changes)) {
  LinkSettings settings = start;
  checkConditions(conditionsOf(settings, Direction::kForward));
  double last = 0.0;
  for (const LinkChange& change : changes_) {
    if (!(std::isfinite(change.at) && change.at >= last))
      throwBadValue("change at", change.at, "finite, 0 s or more, and not before the last change");
    last = change.at;
    apply(settings, change);
    checkConditions(conditionsOf(settings, Direction::kForward));
  }
}

std::size_t LinkPlan::advance(double now) noexcept {
  std::size_t rebinds = 0;
  for (; nextChange() <= now; ++done_) {
    apply(settings_, changes_[done_]);
    if (changes_[done_].rebind) ++rebinds;
  }
  return rebinds;
}

double LinkPlan::nextChange() const noexcept {
  return done_ < changes_.size() ? changes_[done_].at : std::numeric_limits<double>::infinity();
}

}  // namespace tandem
