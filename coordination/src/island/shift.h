#pragma once

#include "island/contact_finder.h"
#include "island/touch.h"

namespace tandem {

/// The part of `offset_W` [m] by which a body may be moved along with `rotation_W`: its rigid
/// contacts get no deeper. `states` is working memory with the states of all bodies; `contacts`
/// has room for what is found. Real-time safe.
[[nodiscard]] Vec3 limitShift(ContactFinder& finder, BodyIndex body, const Vec3& offset_W,
                              const Quat& rotation_W, States& states,
                              std::vector<RigidContact>& contacts) noexcept;

}  // namespace tandem
