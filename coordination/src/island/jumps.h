#pragma once

#include "island/touch.h"

/// \file
/// Bodies and obstacles that are where no motion led them: new, or put there. Contacts that they
/// begin, or make deeper, are let in gently: see TouchMemory.
namespace tandem {

/// False if a body that gets `next` from outside certainly does not jump: the usual case. A hand
/// moves by itself, and a kinematic body by its velocity.
[[nodiscard]] inline bool mayJump(const ModelBody& body, const RigidState& next) noexcept {
  if (body.settings.motion == Motion::kPrescribed) return false;
  constexpr double kNoticed = TouchMemory::kNoticed;
  return (next.p_W - body.state.p_W).squaredNorm() > kNoticed * kNoticed ||
         !std::holds_alternative<Sphere>(body.settings.shape);
}

/// Before a body gets `next` from outside: marks it, and keeps the depths of its contacts, unless
/// velocities explain the move. `states` is working memory.
[[gnu::cold]] void notePlacing(IslandModel& model, BodyIndex body, const RigidState& next,
                               States& states) noexcept;

/// Before a body jumps: keeps the depths of its contacts, and marks it.
[[gnu::cold]] void noteJump(IslandModel& model, BodyIndex body, States& states) noexcept;

/// Gives allowances to deep contacts with bodies and obstacles that have jumped, and wakes the
/// bodies in them. `states` is working memory.
[[gnu::cold]] void letJumpsIn(IslandModel& model, States& states) noexcept;

/// After an advance of `dt` [s]: jumps are over, and allowances fall. `states` is working memory.
[[gnu::cold]] void endJumps(IslandModel& model, double dt, States& states) noexcept;

}  // namespace tandem
