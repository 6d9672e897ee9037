#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "wire/wire_state.h"

/// \file
/// Range checks of STATE, for both sending and receiving. The comparisons are written so that a NaN
/// never passes.
namespace tandem::wire {

/// Object ids of one datagram: each must be known and occur once.
class ObjectIds {
 public:
  [[nodiscard]] WireRefusal add(ObjectId id) noexcept {
    if (id >= kMaxSharedObjects) return WireRefusal::kObjectId;
    std::uint64_t& word = seen_[id / 64];
    const std::uint64_t bit = std::uint64_t{1} << (id % 64);
    if ((word & bit) != 0) return WireRefusal::kObjectTwice;
    word |= bit;
    return WireRefusal::kNone;
  }

 private:
  std::array<std::uint64_t, kMaxSharedObjects / 64> seen_{};
};

inline double computeSquaredLength(const Quat& q) noexcept {
  return q.w() * q.w() + q.x() * q.x() + q.y() * q.y() + q.z() * q.z();
}

/// Normalises a quaternion. One of unit length to rounding stays unchanged, so that float64 values
/// survive the wire exactly.
inline void makeUnit(Quat& q) noexcept {
  constexpr double kRounding = 1e-14;
  const double squared_length = computeSquaredLength(q);
  if (std::abs(squared_length - 1.0) > kRounding) q.coeffs() /= std::sqrt(squared_length);
}

class StateGate {
 public:
  explicit StateGate(const WireLimits& limits) noexcept : limits_(limits) {}

  [[nodiscard]] WireRefusal check(const PointState& state) const noexcept {
    if (!isFinite(state)) return WireRefusal::kNotFinite;
    return checkMotion(state.p_W, state.v_W);
  }

  [[nodiscard]] WireRefusal check(const RigidState& state) const noexcept {
    if (!isFinite(state)) return WireRefusal::kNotFinite;
    if (const auto fault = checkMotion(state.p_W, state.v_W); fault != WireRefusal::kNone)
      return fault;
    if (!isWithin(state.w_W, limits_.angular_velocity)) return WireRefusal::kAngularVelocity;
    return checkTurn(state.q_WB);
  }

  /// A grip that holds nothing has a pose within bounds, too.
  [[nodiscard]] WireRefusal check(const GripState& grip) const noexcept {
    if (grip.object && *grip.object >= kMaxSharedObjects) return WireRefusal::kObjectId;
    if (!grip.p_BG.allFinite() || !grip.q_BG.coeffs().allFinite()) return WireRefusal::kNotFinite;
    if (!(grip.age >= 0.0)) return WireRefusal::kTime;
    if (!isWithin(grip.p_BG, limits_.position)) return WireRefusal::kPosition;
    return checkTurn(grip.q_BG);
  }

  [[nodiscard]] WireRefusal check(const ObjectEpoch& epoch) const noexcept {
    const auto author = static_cast<std::uint32_t>(epoch.author);
    const bool is_right = author <= kMaxPeerId && (author == 0) == (epoch.count == 0);
    return is_right ? WireRefusal::kNone : WireRefusal::kObjectEpoch;
  }

  [[nodiscard]] WireRefusal checkBlock(const StateMessage& message,
                                       std::int64_t state_time_us) const noexcept {
    if ((message.flags & ~kStateFlags) != 0) return WireRefusal::kFlags;
    for (const std::int64_t time : {message.send_time_us, state_time_us, message.echo_send_time_us})
      if (time < 0 || time > kMaxWireTimeUs) return WireRefusal::kTime;
    for (const double energy : {message.energy.granted, message.energy.holdings})
      if (!(std::abs(energy) <= limits_.energy)) return WireRefusal::kEnergy;
    return WireRefusal::kNone;
  }

  /// Checks everything that a receiver checks.
  [[nodiscard]] WireRefusal check(const StateMessage& message) const noexcept {
    const StatePacket& packet = message.packet;
    if (message.profile > WireProfile::kFloat64) return WireRefusal::kProfile;
    if (packet.object_count > packet.objects.size()) return WireRefusal::kObjectCount;
    if (const auto fault = checkBlock(message, toMicroseconds(packet.time));
        fault != WireRefusal::kNone)
      return fault;
    if (const auto fault = check(packet.user); fault != WireRefusal::kNone) return fault;
    if (packet.grip)
      if (const auto fault = check(*packet.grip); fault != WireRefusal::kNone) return fault;
    ObjectIds seen;
    for (std::size_t i = 0; i < packet.object_count; ++i) {
      const ObjectState& object = packet.objects[i];
      if (const auto fault = seen.add(object.id); fault != WireRefusal::kNone) return fault;
      if (const auto fault = check(object.epoch); fault != WireRefusal::kNone) return fault;
      if (const auto fault = check(object.state); fault != WireRefusal::kNone) return fault;
    }
    return WireRefusal::kNone;
  }

 private:
  static bool isWithin(const Vec3& vector, double bound) noexcept {
    return vector.cwiseAbs().maxCoeff() <= bound;
  }

  [[nodiscard]] static WireRefusal checkTurn(const Quat& rotation) noexcept {
    constexpr double kUnitTolerance = 1e-3;
    const bool is_unit = std::abs(computeSquaredLength(rotation) - 1.0) < kUnitTolerance;
    return is_unit ? WireRefusal::kNone : WireRefusal::kOrientation;
  }

  [[nodiscard]] WireRefusal checkMotion(const Vec3& position, const Vec3& velocity) const noexcept {
    if (!isWithin(position, limits_.position)) return WireRefusal::kPosition;
    if (!isWithin(velocity, limits_.velocity)) return WireRefusal::kVelocity;
    return WireRefusal::kNone;
  }

  WireLimits limits_;
};

}  // namespace tandem::wire
