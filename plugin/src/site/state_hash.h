#pragma once

#include <cstdint>

#include "tandem/coordination/types.h"

#include "coordination/src/fnv.h"

namespace tandem {

/// FNV-1a over 64-bit words, fed with the bits of numbers.
class StateHash {
 public:
  void add(double value) noexcept { fnv_.addWord(value); }
  void add(const Vec3& v) noexcept { add(v.x()), add(v.y()), add(v.z()); }
  void add(const RigidState& s) noexcept {
    add(s.p_W), add(s.v_W), add(s.w_W);
    add(s.q_WB.w()), add(Vec3(s.q_WB.vec()));
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return fnv_.value(); }

 private:
  Fnv fnv_;
};

}  // namespace tandem
