#pragma once

#include <cstddef>
#include <vector>

namespace tandem::demos::bench {

class Draw;
class GuestSite;
class GuestWorld;

/// Something that a host may legally do at run time. It does the same to a world and to its twin:
/// all that it draws is independent of the state of bodies.
struct GuestAct {
  const char* name;
  bool in_step;  ///< also legal in the host's own callbacks during stepSimulation()
  void (*apply)(GuestWorld& world, Draw& draw);
  /// Instead: done to a site, which the twin lacks.
  void (*apply_to_site)(GuestSite& site, Draw& draw) = nullptr;
};

/// All acts: the setters of btRigidBody and btCollisionObject, and of the world and its joints,
/// and calls of Site.
[[nodiscard]] const std::vector<GuestAct>& guestActs();

/// Acts that are drawn from one stream, by their index.
struct GuestActRange {
  int first, last;
};
/// Done in all worlds; to arms; and those that came later, which some worlds draw besides.
[[nodiscard]] GuestActRange worldActs();
[[nodiscard]] GuestActRange armActs();
[[nodiscard]] GuestActRange moreActs();

/// @name Parts of the table.
/// @{
void appendMassActs(std::vector<GuestAct>& acts);
void appendSurfaceActs(std::vector<GuestAct>& acts);
void appendMotionActs(std::vector<GuestAct>& acts);
void appendPresenceActs(std::vector<GuestAct>& acts);
void appendWorldActs(std::vector<GuestAct>& acts);
void appendJointActs(std::vector<GuestAct>& acts);
void appendSiteActs(std::vector<GuestAct>& acts);
void appendArmActs(std::vector<GuestAct>& acts);
void appendMoreActs(std::vector<GuestAct>& acts);
/// @}

}  // namespace tandem::demos::bench
