#include "watch/watched_track.h"

#include <algorithm>

namespace tandem::view {
namespace {

/// A way that has become longer is believed at this rate [s/s].
constexpr double kDrift = 0.01;

}  // namespace

void WatchedTrack::take(const WatchedSite& site) {
  if (site.states == states_) return;
  const StatePacket& packet = site.newest;
  const double offset = site.heard_at - packet.time, silence = site.heard_at - heard_at_;
  // A site that was away or has begun anew may have another clock.
  if (states_ == 0 || silence > kSilent || packet.time <= time_) begin(packet.time, offset);
  offset_ = std::min(offset, offset_ + kDrift * silence);
  states_ = site.states;
  heard_at_ = site.heard_at;
  time_ = packet.time;
  hand_.add(time_, {packet.user.p_W, Quat::Identity(), packet.user.v_W, Vec3::Zero()});
  for (std::uint32_t i = 0; i < packet.object_count; ++i)
    objects_[packet.objects[i].id].add(time_, packet.objects[i].state, packet.objects[i].epoch);
}

void WatchedTrack::begin(double time, double offset) {
  hand_.standUntil(time - MotionHistory::kLongest);
  for (auto& [id, history] : objects_) history.standUntil(time - MotionHistory::kLongest);
  offset_ = offset;
}

Vec3 WatchedTrack::hand(double now) const {
  const auto state = hand_.at(shownTime(now));
  return state ? state->p_W : Vec3::Zero();
}

std::optional<RigidState> WatchedTrack::object(ObjectId id, double now) const {
  const auto history = objects_.find(id);
  return history == objects_.end() ? std::nullopt : history->second.at(shownTime(now));
}

}  // namespace tandem::view
