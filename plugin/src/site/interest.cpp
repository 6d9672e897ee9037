#include "site/interest.h"

#include <algorithm>

#include "site/idle_stride.h"

namespace tandem {
namespace {

/// Packets between two looks at one peer; looks at several peers are spread over them.
constexpr std::uint64_t kLookStride = 4;
/// Packets that say that packets get rare, before they do: some may be lost.
constexpr int kNotices = 5;
/// A packet to a far peer has room for the most urgent object, and one that has its turn.
constexpr std::size_t kLeastPlaces = 2;

}  // namespace

Interest::Interest(const SiteSettings& settings, const Island& island, const Bodies& bodies,
                   const Peers& peers) noexcept
    : settings_(settings),
      island_(island),
      bodies_(bodies),
      peers_(peers),
      budget_(settings.packet_budget),
      stride_(computeIdleStride(settings.packet_rate)) {}

void Interest::setSize(std::size_t objects, std::size_t peers) {
  for (std::size_t i = motions_.size(); i < objects; ++i)
    motions_.emplace_back(bodies_.objects[i].bounding_radius);
  audiences_.resize(peers, Audience(settings_.packet_rate));
  for (Audience& audience : audiences_) audience.told.setCount(objects);
  const std::size_t places = std::min<std::size_t>(objects, kMaxObjectsPerPacket);
  is_bound_ = budget_.binds(static_cast<double>(peers) * settings_.packet_rate *
                            computeDatagramBytes(places, true, settings_.membership.follows));
  is_choosing_ = is_bound_ || objects > kMaxObjectsPerPacket;
}

Reach Interest::makeReach(const PointState& user, double radius, PeerId id,
                          const std::optional<GripState>& grip) const noexcept {
  Reach reach{{user.p_W, user.v_W, radius}, std::nullopt};
  const auto held = grip ? grip->object : std::nullopt;
  if (held && *held < motions_.size()) reach.held = motions_[*held].ball();
  for (const SharedObject& object : bodies_.objects)
    if (object.tool_of == id) reach.held = motions_[object.id].ball();
  return reach;
}

void Interest::look(const PointState& user, const std::optional<GripState>& grip,
                    std::uint64_t number, double time) noexcept {
  number_ = number;
  if (!is_choosing_) return;
  if (is_bound_) budget_.fill(time);
  has_grip_ = grip.has_value();
  has_begun_ = false;
  for (const SharedObject& object : bodies_.objects)
    has_begun_ |= motions_[object.id].note(island_.state(object.body.index), time);
  const Reach local = makeReach(user, settings_.hip_radius, settings_.self, grip);
  for (ObjectMotion& motion : motions_) motion.noteGap(local.computeGapSoon(motion.ball()), time);
  for (const Peer& peer : peers_)
    if (isTurnOf(peer, kLookStride)) look(peer, local, time);
}

/// Finds how near the objects are to the peer's hand or ours, and the hands to each other.
void Interest::look(const Peer& peer, const Reach& local, double time) noexcept {
  Audience& audience = audiences_[static_cast<std::size_t>(peer.place)];
  if (audience.rejoined_by != peer.rejoined_by) audience.told.forget(time);
  audience.rejoined_by = peer.rejoined_by;
  if (!peer.is_heard) return;
  const Reach remote =
      makeReach(peer.latest.user, settings_.proxy.radius, peer.id, peer.latest.grip);
  Nearness users = computeNearness(remote.computeGapSoon(local.hand), audience.nearness.value());
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const Nearness ours = motions_[i].nearness();
    const Nearness theirs = computeNearness(remote.computeGapSoon(motions_[i].ball()), ours);
    audience.told.look(i, std::max(ours, theirs), time);
    if (std::min(ours, theirs) == Nearness::kTouch) users = Nearness::kTouch;
  }
  audience.nearness.update(users, time);
  if (!isFar(peer)) audience.notices = kNotices;
}

bool Interest::isFar(const Peer& peer) const noexcept {
  const Audience& audience = audiences_[static_cast<std::size_t>(peer.place)];
  return is_bound_ && audience.nearness.value() == Nearness::kFar;
}

bool Interest::isDue(const Peer& peer) const noexcept {
  if (!isFar(peer) || isTurnOf(peer, 2 * stride_)) return true;
  const Audience& audience = audiences_[static_cast<std::size_t>(peer.place)];
  if (audience.notices > 0 || (has_begun_ && budget_.left() > 0.0)) return true;
  return isTurnOf(peer, stride_) && !budget_.isShort();
}

/// Peers take turns, so that their packets spread evenly.
bool Interest::isTurnOf(const Peer& peer, std::uint64_t stride) const noexcept {
  return (number_ + static_cast<std::uint64_t>(peer.place)) % stride == 0;
}

/// Near peers are told all that is due; far ones share what is left.
PacketRoom Interest::computeRoom(const Peer& peer, std::size_t sharers) const noexcept {
  PacketRoom room;
  room.fills = !is_bound_ || budget_.isFull();
  room.next = 1.0 / settings_.packet_rate;
  if (!isFar(peer)) return room;
  room.prefers_nearest = false;
  room.next *= static_cast<double>(isTurnOf(peer, 2 * stride_) ? 2 * stride_ : stride_);
  constexpr double kObject = computeDatagramBytes(1, false) - computeDatagramBytes(0, false);
  const double part = isTurnOf(peer, stride_) ? budget_.left() / static_cast<double>(sharers) : 0.0;
  const double places =
      (part - computeDatagramBytes(0, has_grip_, settings_.membership.follows)) / kObject;
  room.places =
      static_cast<std::size_t>(std::clamp<double>(places, kLeastPlaces, kMaxObjectsPerPacket));
  return room;
}

const std::vector<std::size_t>& Interest::choose(const Peer& peer, std::size_t sharers,
                                                 double time) noexcept {
  Audience& audience = audiences_[static_cast<std::size_t>(peer.place)];
  const auto& chosen = audience.told.choose(motions_, computeRoom(peer, sharers), time);
  if (is_bound_)
    budget_.spend(computeDatagramBytes(chosen.size(), has_grip_, settings_.membership.follows));
  if (isFar(peer) && audience.notices > 0) --audience.notices;
  return chosen;
}

}  // namespace tandem
