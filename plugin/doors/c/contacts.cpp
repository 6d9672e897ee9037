#include <algorithm>

#include "bullet_bridge/src/world/world_access.h"
#include "c/values.h"
#include "c/world.h"

namespace tandem::c_door {
namespace {

[[nodiscard]] TandemContact describe(const World& world, const WorldContact& contact) noexcept {
  TandemContact out{};
  out.a = world.find(contact.a);
  out.b = world.find(contact.b);
  writeVec3(contact.p_a, out.point_a);
  writeVec3(contact.p_b, out.point_b);
  writeVec3(contact.n, out.normal);
  out.distance = contact.distance;
  out.force = contact.force;
  writeVec3(contact.friction, out.friction);
  return out;
}

}  // namespace
}  // namespace tandem::c_door

using namespace tandem;          // NOLINT: the functions of the header are in no namespace
using namespace tandem::c_door;  // NOLINT

extern "C" {

TandemResult tandem_world_get_contacts(const TandemWorld* world, size_t room,
                                       TandemContact* contacts, size_t* count) {
  return guarded([&] {
    const World& in = open(world);
    if (room > 0) checkPointer(contacts, "contacts");
    const std::vector<WorldContact> found = findContacts(in.bullet());
    const std::size_t written = std::min(room, found.size());
    for (std::size_t i = 0; i < written; ++i) contacts[i] = describe(in, found[i]);
    if (count) *count = found.size();
  });
}

}  // extern "C"
