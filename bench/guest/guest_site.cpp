#include "bench/guest/guest_site.h"

#include <algorithm>

#include "tandem/bullet_bridge/convert.h"

#include "bench/guest/guest_acts.h"
#include "bench/guest/guest_energy.h"
#include "bench/guest/guest_tears.h"

namespace tandem::demos::bench {
namespace {

constexpr double kTick = 1e-3;        // [s]
constexpr double kTargetTime = 0.15;  // a hand looks for another body after this [s]
constexpr double kReset = 0.04;       // no body moves as far in a step, but by a reset [m]

/// Multi-bodies of a world, and their motors, limits and ties.
std::pair<int, int> countArmParts(const btDiscreteDynamicsWorld& world) {
  const auto* multi = dynamic_cast<const btMultiBodyDynamicsWorld*>(&world);
  if (!multi) return {0, 0};
  return {multi->getNumMultibodies(), multi->getNumMultiBodyConstraints()};
}

GuestFrame::Deed makeDeed(const GuestActPlan& plan) {
  return [plan](GuestWorld& world) {
    Draw draw(plan.seed, 0);
    guestActs()[static_cast<std::size_t>(plan.act)].apply(world, draw);
  };
}

PeerId peerOf(int site) { return PeerId{static_cast<std::uint32_t>(site) + 1}; }

}  // namespace

GuestSite::GuestSite(const GuestCase& one, int self)
    : case_(one),
      self_(self),
      world_(one),
      twin_(one),
      device_(one.hands[static_cast<std::size_t>(self)], one.index) {
  noteHooks();
  begin();
}

void GuestSite::noteHooks() {
  pre_tick_ = world_.watch().preTick();
  post_tick_ = world_.watch().postTick();
  user_ = world_.world().getWorldUserInfo();
  islands_ = world_.watch().islands();
}

void GuestSite::begin() {
  SiteSettings settings;
  settings.self = peerOf(self_);
  settings.peers = case_.sites;
  settings.contact = {1000.0, 5.0};
  settings.coordination = {500.0, 10.0};
  settings.host_step = case_.step();
  settings.max_neighbours = case_.max_neighbours;
  settings.hand_feels_moving_bodies = case_.hand_feels;
  if (case_.is_caller) settings.tick_source = TickSource::kCaller;
  site_ = std::make_unique<Site>(settings, world_.world(), device_);
  for (int b = 0; b < case_.shared; ++b) {
    GuestBody& body = *world_.bodies()[static_cast<std::size_t>(b)];
    try {
      site_->share(*body.rigid);
      body.was_shared = true;
    } catch (const Error&) {
      // A shape or state that cannot be shared is refused with its reason.
    }
  }
  for (const auto& [other, link] : links_) site_->connect(peerOf(other), *link, Vec3(0, 0, 0.5));
}

void GuestSite::connect(int other, Link& link) {
  links_.emplace_back(other, &link);
  site_->connect(peerOf(other), link, Vec3(0, 0, 0.5));
}

void GuestSite::doAct(const GuestActPlan& plan) {
  if (plan.in_callback) return pending_.push_back(plan);
  const GuestAct& act = guestActs()[static_cast<std::size_t>(plan.act)];
  Draw draw(plan.seed, 0);
  if (act.apply_to_site) return act.apply_to_site(*this, draw);
  act.apply(world_, draw);
  doToTwin(makeDeed(plan));
}

/// Between two steps.
void GuestSite::doToTwin(const GuestFrame::Deed& deed) {
  deed(twin_);
  frame_.before.push_back(deed);
}

void GuestSite::step(double time) {
  const std::size_t target = static_cast<std::size_t>(time / kTargetTime) % world_.bodies().size();
  const Vec3 p_W = target == 0 && !world_.arms().empty() ? world_.arms()[0]->places().back()
                                                         : placeOf(*world_.bodies()[target]);
  if (p_W.allFinite() && p_W.norm() < 1.0) device_.setTarget(p_W);
  simulated_ += world_.watch().foresee(case_.frame, case_.max_substeps, case_.fixed_step);
  if (case_.is_caller)
    for (; static_cast<double>(ticks_) * kTick < simulated_ - 1e-9; ++ticks_)
      if (site_) site_->tick(static_cast<double>(ticks_) * kTick);
  frame_.time = time;
  for (const GuestActPlan& plan : pending_) frame_.within.push_back(makeDeed(plan));
  pending_.clear();
  const auto doPending = [&](GuestWorld& world) {
    return [&] {
      if (frame_.within.empty()) return;
      const double before = energyOf(world) + tearsOf(world);
      for (const GuestFrame::Deed& deed : frame_.within) deed(world);
      given_ += std::max(0.0, energyOf(world) + tearsOf(world) - before);
    };
  };
  findPlaces();
  const std::uint64_t resets = site_ ? site_->counters().resets_followed : 0;
  const double tears = case_.sites > 1 ? tearsOf(world_) : 0.0;
  world_.step(time, doPending(world_));
  twin_.step(time, doPending(twin_));
  // A peer's reset tears the joints of our copy.
  if (site_ && site_->counters().resets_followed > resets)
    given_ += std::max(0.0, tearsOf(world_) - tears);
  followResets();
  journal_.push_back(std::exchange(frame_, {}));
}

void GuestSite::findPlaces() {
  places_.clear();
  for (const auto& body : world_.bodies()) places_.push_back(placeOf(*body));
}

/// A host puts a body elsewhere, and its peers' copies follow. So do these copies' twins.
void GuestSite::followResets() {
  if (!site_ || site_->counters().resets_followed == 0) return;
  for (std::size_t b = 0; b < places_.size(); ++b) {
    const GuestBody& body = *world_.bodies()[b];
    const double way = (placeOf(body) - places_[b]).norm();
    const double speed = fromBullet(body.rigid->getLinearVelocity()).norm();
    if (!body.was_shared || !(way > kReset + speed * case_.frame)) continue;
    const auto put = [b, motion = world_.motionOf(b)](GuestWorld& world) { world.put(b, motion); };
    put(twin_);
    frame_.after.emplace_back(put);
  }
}

void GuestSite::unshare(Draw& draw) {
  if (!site_ || site_->objectCount() == 0) return;
  site_->unshare(static_cast<ObjectId>(draw.count(0, site_->objectCount() - 1)));
}

void GuestSite::shareAgain(Draw& draw) {
  if (!site_ || site_->objectCount() == 0) return;
  const auto id = static_cast<ObjectId>(draw.count(0, site_->objectCount() - 1));
  GuestBody& body = world_.drawDynamicBody(draw);
  try {
    site_->share(id, *body.rigid);
    body.was_shared = true;
  } catch (const Error&) {
    // Refused with its reason: shared already, not in the world, of another shape.
  }
}

/// A site cannot restore what is not in its world.
void GuestSite::beginAnother() {
  world_.putBack();
  doToTwin([](GuestWorld& world) { world.putBack(); });
  end();
  if (left_over_.empty()) left_over_ = findLeftOver();
  begin();
}

void GuestSite::changeHand(Draw& draw) {
  if (case_.is_idle) return;
  device_.setHand(static_cast<GuestHand>(draw.count(0, kGuestHandCount - 1)));
}

void GuestSite::end() { site_.reset(); }

std::string GuestSite::findHookLeft() {
  btDiscreteDynamicsWorld &own = world_.world(), &other = twin_.world();
  const GuestWatch& watch = world_.watch();
  if (watch.preTick() != pre_tick_ || watch.postTick() != post_tick_) return "tick callback";
  if (own.getWorldUserInfo() != user_) return "user pointer of the world";
  if (watch.islands() != islands_) return "island manager";
  if (own.getNumCollisionObjects() != other.getNumCollisionObjects()) return "number of objects";
  if (own.getNumConstraints() != other.getNumConstraints()) return "number of joints";
  if (countArmParts(own) != countArmParts(other)) return "number of multi-bodies or constraints";
  if (own.getForceUpdateAllAabbs() != other.getForceUpdateAllAabbs()) return "update of boxes";
  if (own.getGravity() != other.getGravity()) return "gravity";
  return {};
}

std::string GuestSite::findLeftOver() {
  if (world_.hasWorld())
    if (std::string hook = findHookLeft(); !hook.empty()) return "world: " + hook;
  for (std::size_t b = 0; b < world_.bodies().size(); ++b)
    if (std::string what = compareSettings(world_, twin_, b); !what.empty())
      return "body " + std::to_string(b) + ":" + what;
  for (std::size_t a = 0; a < world_.arms().size(); ++a)
    if (std::string what = compareArms(*world_.arms()[a], *twin_.arms()[a]); !what.empty())
      return "arm " + std::to_string(a) + ":" + what;
  return {};
}

void appendSiteActs(std::vector<GuestAct>& acts) {
  acts.insert(
      acts.end(),
      {{"unshare", false, nullptr, [](GuestSite& site, Draw& draw) { site.unshare(draw); }},
       {"share again", false, nullptr, [](GuestSite& site, Draw& draw) { site.shareAgain(draw); }},
       {"site ends, another begins", false, nullptr,
        [](GuestSite& site, Draw&) { site.beginAnother(); }},
       {"the hand changes", false, nullptr,
        [](GuestSite& site, Draw& draw) { site.changeHand(draw); }}});
}

}  // namespace tandem::demos::bench
