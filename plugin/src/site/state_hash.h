#pragma once

#include <bit>
#include <cstdint>

#include "tandem/coordination/types.h"

namespace tandem {

/// FNV-1a over 64-bit words, fed with the bits of numbers.
class StateHash {
 public:
  void add(double value) noexcept {
    hash_ = (hash_ ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001b3u;
  }
  void add(const Vec3& v) noexcept { add(v.x()), add(v.y()), add(v.z()); }
  void add(const RigidState& s) noexcept {
    add(s.p_W), add(s.v_W), add(s.w_W);
    add(s.q_WB.w()), add(Vec3(s.q_WB.vec()));
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

}  // namespace tandem
