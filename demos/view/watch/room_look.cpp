#include "watch/room_look.h"

#include <algorithm>
#include <string>

#include "tandem/bullet_bridge/convert.h"

namespace tandem::view {
namespace {

/// Nearly that of the background.
Colour fade(const Colour& colour) {
  constexpr float kShare = 0.7F, kGrey = 0.85F;
  const auto mix = [](float channel) { return channel + kShare * (kGrey - channel); };
  return {mix(colour.red), mix(colour.green), mix(colour.blue)};
}

std::vector<demos::SceneBody> describeBodies(const demos::SceneWorld& scene) {
  std::vector<demos::SceneBody> bodies;
  for (const demos::PlacedBody& placed : scene.bodies()) bodies.push_back(describeBody(placed));
  return bodies;
}

}  // namespace

RoomLook::RoomLook(const demos::Scenario& scenario)
    : scene_(scenario),
      scene_look_(scene_.world(), describeBodies(scene_)),
      ball_(makeBall(scenario.site.proxy.radius)) {
  // A site shares them in this order.
  for (const demos::PlacedBody& placed : scene_.bodies())
    if (placed.plan.body.shared) shared_.push_back(placed);
}

void RoomLook::take(int user, const WatchedSite& site, bool fits) {
  User& seen = users_[user];
  seen.fits = fits;
  seen.track.take(site);
}

std::optional<int> RoomLook::chooseFollowed(std::optional<int> wanted) const {
  const auto fits = [](const auto& entry) { return entry.second.fits; };
  const auto found = wanted ? users_.find(*wanted) : users_.end();
  if (found != users_.end() && fits(*found)) return wanted;
  const auto first = std::ranges::find_if(users_, fits);
  return first == users_.end() ? std::nullopt : std::optional(first->first);
}

SessionLook RoomLook::look(double now, std::optional<int> wanted, const WorldDetails& details) {
  SessionLook look;
  look.followed = chooseFollowed(wanted);
  look.is_waiting = !look.followed;
  const WatchedTrack* track = look.followed ? &users_.at(*look.followed).track : nullptr;
  if (track) placeObjects(*track, now);
  look.list = scene_look_.look(details);
  for (const auto& [user, seen] : users_)
    if (seen.fits && seen.track.isLive(now) && user != look.followed)
      look.apart = std::max(look.apart, addCopies(look.list, user, now));
  if (track && !track->isLive(now)) fadeObjects(look.list);
  addHands(look, now);
  if (track) look.hip_W = track->hand(now);
  if (!shared_.empty()) look.object_W = fromBullet(shared_.front().body->getCenterOfMassPosition());
  return look;
}

void RoomLook::placeObjects(const WatchedTrack& track, double now) {
  for (std::size_t id = 0; id < shared_.size(); ++id)
    if (const auto state = track.object(static_cast<ObjectId>(id), now))
      shared_[id].body->setCenterOfMassTransform(
          btTransform(toBullet(state->q_WB), toBullet(state->p_W)));
}

void RoomLook::fadeObjects(DrawList& list) const {
  for (Solid& solid : list.solids)
    if (std::ranges::any_of(shared_, [&](const demos::PlacedBody& placed) {
          return placed.plan.body.name == solid.name && !solid.is_ghost;
        }))
      solid.colour = fade(solid.colour);
}

double RoomLook::addCopies(DrawList& list, int user, double now) const {
  double apart = 0.0;
  const WatchedTrack& track = users_.at(user).track;
  for (std::size_t id = 0; id < shared_.size(); ++id)
    if (const auto state = track.object(static_cast<ObjectId>(id), now))
      apart = std::max(apart,
                       addGhost(list, shared_[id].plan.body.name, *state, chooseUserColour(user)));
  return apart;
}

void RoomLook::addHands(SessionLook& look, double now) const {
  for (const auto& [user, seen] : users_) {
    const UserLook one{user, seen.track.hand(now), seen.track.age(now), seen.track.isLive(now),
                       !seen.fits};
    look.users.push_back(one);
    if (!seen.fits) continue;
    const Colour colour = chooseUserColour(user);
    addHand(look.list, ball_, one.hand_W, Vec3::Zero(), one.is_live ? colour : fade(colour));
    look.list.solids.back().name += " " + std::to_string(user + 1);
  }
}

}  // namespace tandem::view
