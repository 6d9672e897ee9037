#include <algorithm>
#include <cmath>

#include "site/site_impl.h"

// What is around the island's bodies in the host's world, looked at once per host step.
//
//   standing objects  -> Obstacles: searched for contact at each inner step
//   moving bodies     -> promoted: the island holds them while they may take part in contact
//
// A promoted body is an island body like any other: the host gets its motion by hand-off, and its
// own forces on it reach the island. It comes with the state that the host has it in, at the host's
// simulated time; where the island is ahead of that, all that come together are moved on together.

namespace tandem {
namespace {

/// The host may be this many of its periods late.
constexpr double kLatePeriods = 2.5;
/// Margin of the search for standing objects besides what speed needs [m].
constexpr double kStandingMargin = 0.04;
constexpr double kSafety = 1.5;

constexpr double kSameTime = 1e-9;  // [s]

/// States kept besides those that a host as late as it may be asks for.
constexpr std::size_t kSpareSnapshots = 4;

NeighbourSeed makeSphereSeed(const RigidState& state, double radius) {
  const Vec3 half = Vec3::Constant(radius);
  return {state.p_W - half, state.p_W + half, state.v_W};
}

bool hasChanged(const Neighbour& neighbour) {
  return neighbour.rigid->getCollisionShape() != neighbour.shape ||
         neighbour.rigid->isKinematicObject() != (neighbour.driven != nullptr) ||
         (neighbour.bullet && !neighbour.bullet->hasItsMass());
}

}  // namespace

void Site::Impl::makeRoomFor(double host_step_time) {
  if (!(host_step_time > 0.0)) return;
  const double horizon = kLatePeriods * host_step_time + settings.host_stall;
  snapshots.makeRoom(static_cast<std::size_t>(horizon / host_step_time) + kSpareSnapshots);
}

/// What a search needs to know of the island.
void Site::Impl::mirrorIsland() noexcept {
  if (settings.guide) return;
  mirror.speed = 0.0;
  for (std::size_t b = 0; b < mirror.states.size(); ++b) {
    mirror.states[b] = island.state(static_cast<BodyIndex>(b));
    mirror.speed = std::max(mirror.speed, mirror.states[b].v_W.norm());
  }
  std::fill(mirror.moves.begin(), mirror.moves.end(), char{0});
  for (const BodyIndex b : island.awakeBodies()) mirror.moves[static_cast<std::size_t>(b)] = 1;
}

void Site::Impl::updateSurroundings(double dt) {
  // The enclosure of a guide has no end, and nothing else in it.
  if (settings.guide) return;
  const double horizon = kLatePeriods * dt + settings.host_stall;
  updateNeighbours(horizon);
  // Springs that are stretched, also by what was just found, may shoot a body farther.
  double way_by_springs = 0.0;
  bool changed = searchObstacles(horizon, 0.0);
  desk.run([&] {
    takeObstacles();
    if (!island.isAsleep()) way_by_springs = kSafety * computeSpeedInSprings() * horizon;
    if (way_by_springs <= kStandingMargin) finishSurroundings(changed);
  });
  if (way_by_springs <= kStandingMargin) return;
  changed |= searchObstacles(horizon, way_by_springs);
  desk.run([&] {
    takeObstacles();
    finishSurroundings(changed);
  });
}

/// `way` [m]: that bodies may go besides what their speed takes them.
bool Site::Impl::searchObstacles(double horizon, double way) {
  const std::vector<char>* of_interest = isFullSearch() ? nullptr : &mirror.moves;
  return obstacles.search(mirror.states, kStandingMargin + kSafety * mirror.speed * horizon + way,
                          of_interest);
}

void Site::Impl::takeObstacles() noexcept {
  obstacles.commit();
  island.setObstacles(obstacles.nearSpheres());
}

void Site::Impl::finishSurroundings(bool changed) noexcept {
  if (changed) island.wake();
  catchUp();
  noteSearched();
}

/// Around bodies that sleep with nothing awake near them it is enough to look now and then.
bool Site::Impl::isFullSearch() const noexcept {
  constexpr std::uint64_t kStepsBetweenFullSearches = 8;
  return counters.searches % kStepsBetweenFullSearches == 0;
}

std::size_t Site::Impl::countHapticBodies() const noexcept {
  const auto has_body = [](const Remote& remote) { return remote.proxy != nullptr; };
  const auto proxies = std::count_if(remotes.begin(), remotes.end(), has_body);
  return 1 + objects.size() + static_cast<std::size_t>(proxies);
}

/// What springs that are stretched now can add to the speed of any body at the most [m/s]: a spring
/// K stretched by x moves m no faster than x sqrt(K / m).
double Site::Impl::computeSpeedInSprings() noexcept {
  double most = 0.0;
  forEachBody([&](const SiteBody& body) {
    const BodyIndex b = body.index;
    if (body.bullet->isParked() || !island.isDynamic(b)) return;
    const double mass = island.body(b).mass;
    double speed = 0.0;
    if (settings.contact.stiffness > 0.0)
      speed += island.computeContactForce(b).norm() / std::sqrt(settings.contact.stiffness * mass);
    for (CouplerIndex c = 0; c < island.couplerCount(); ++c) {
      if (island.follower(c) != b) continue;
      const RigidState& target = island.target(c);
      const double way = (target.p_W - island.state(b).p_W).norm();
      const double stiffness = island.couplerShare(c) * island.couplerSettings(c).linear.stiffness;
      speed += target.v_W.norm() + way * std::sqrt(stiffness / mass);
    }
    most = std::max(most, speed);
  });
  return most;
}

void Site::Impl::updateNeighbours(double horizon) {
  // A hand alone feels what stands, and takes nothing of the host's.
  if (neighbours.empty() || isBare()) return;
  const bool is_full = isFullSearch();
  const auto is_calm = [&](const SiteBody& body) {
    return !is_full && body.bullet->isParked() && !body.was_near_awake;
  };
  const auto state = [&](BodyIndex b) { return mirror.states[static_cast<std::size_t>(b)]; };
  seeds.clear();
  seeds.push_back(makeSphereSeed(state(hip), settings.hip_radius));
  for (const Remote& remote : remotes)
    if (remote.proxy && !is_calm(remote.body))
      seeds.push_back(makeSphereSeed(state(remote.body.index), settings.proxy.radius));
  for (const SharedObject& object : objects)
    if (!is_calm(object.body))
      seeds.push_back(makeSphereSeed(state(object.body.index), object.bounding_radius));

  const std::vector<btRigidBody*>& near = neighbour_search.find(seeds, horizon);
  // Who is not found by a search around some of us may be near the others.
  const bool is_whole = seeds.size() == countHapticBodies();
  leaving.clear();
  for (Neighbour& neighbour : neighbours) {
    if (!neighbour.rigid) continue;
    const bool is_near = std::find(near.begin(), near.end(), neighbour.rigid) != near.end();
    // One that the host has made another comes back as that, in the same breath.
    if ((is_whole && !is_near) || hasChanged(neighbour)) leaving.push_back(&neighbour);
  }
  demoteLeaving();
  bool has_come = false;
  for (btRigidBody* rigid : near) {
    const auto holds = [&](const Neighbour& neighbour) { return neighbour.rigid == rigid; };
    if (std::any_of(neighbours.begin(), neighbours.end(), holds)) continue;
    const auto slot = std::find_if(neighbours.begin(), neighbours.end(),
                                   [](const Neighbour& neighbour) { return !neighbour.rigid; });
    if (slot == neighbours.end()) continue;
    promote(*rigid, *slot);
    has_come = true;
  }
  if (has_come) desk.run([&] { takeNewcomers(); });
}

/// Newcomers come in the state of the host's time; the island may be ahead of it.
void Site::Impl::catchUp() {
  if (newcomers.empty()) return;
  double time = host_time;
  std::fill(asides.begin(), asides.end(), Aside{});
  readStates(time, from_states);
  while (island_time - time > kSameTime) {
    // They stop where the host's next steps end: it will ask for their states there.
    const double stop = std::min(island_time, snapshots.nextAfter(time + kSameTime));
    readStates(stop, to_states);
    island.catchUp(newcomers, from_states, to_states, stop - time, asides);
    if (auto* states = snapshots.find(stop, kSameTime))
      for (BodyIndex index : newcomers) (*states)[index] = island.state(index);
    time = stop;
    from_states.swap(to_states);
  }
  for (BodyIndex index : newcomers) tick_start_states[index] = island.state(index);
  for (const Neighbour& neighbour : neighbours)
    if (std::find(newcomers.begin(), newcomers.end(), neighbour.body.index) != newcomers.end())
      countNeighbour(neighbour, 1.0);
  newcomers.clear();
  // Whom they touched in the past has the momentum now.
  forEachBody([&](SiteBody& body) {
    const Aside& aside = asides[body.index];
    const RigidState& now = island.state(body.index);
    const IslandBody& own = island.body(body.index);
    give(body, own.mass * aside.v_W,
         now.q_WB * own.inertia_B.cwiseProduct(now.q_WB.conjugate() * aside.w_W));
  });
}

/// States of all bodies at a moment.
void Site::Impl::readStates(double time, std::vector<RigidState>& states) {
  const std::vector<RigidState>* kept = snapshots.find(time, kSameTime);
  for (std::size_t b = 0; b < states.size(); ++b)
    states[b] = kept ? (*kept)[b] : stateAt(static_cast<BodyIndex>(b), time);
  for (const Neighbour& neighbour : neighbours)
    if (neighbour.driven) states[neighbour.body.index] = neighbour.driven->at(time);
}

}  // namespace tandem
