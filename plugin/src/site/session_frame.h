#pragma once

#include "tandem/coordination/link.h"

namespace tandem {

/// Frame S that does not follow the host's shifts of its world's origin. Devices give positions in
/// it, and so do packets: a peer never learns of a shift.
///
///   p_W = p_S + sum of all shifts
///
/// Without a shift all bits stay. Plain value; real-time safe.
class SessionFrame {
 public:
  void shiftOrigin(const Vec3& offset_W) noexcept {
    p_WS_ += offset_W;
    is_shifted_ = true;
  }

  [[nodiscard]] PointState toWorld(PointState state) const noexcept { return moved(state, p_WS_); }
  /// Converts all states of a packet that was received.
  void toWorld(StatePacket& packet) const noexcept {
    if (!is_shifted_) return;
    packet.user.p_W += p_WS_;
    for (std::uint32_t i = 0; i < packet.object_count; ++i) packet.objects[i].state.p_W += p_WS_;
  }

  [[nodiscard]] PointState toSession(PointState state) const noexcept {
    return moved(state, -p_WS_);
  }
  [[nodiscard]] RigidState toSession(RigidState state) const noexcept {
    return moved(state, -p_WS_);
  }

 private:
  template <typename State>
  [[nodiscard]] State moved(State state, const Vec3& offset) const noexcept {
    if (is_shifted_) state.p_W += offset;
    return state;
  }

  Vec3 p_WS_ = Vec3::Zero();
  bool is_shifted_ = false;
};

}  // namespace tandem
