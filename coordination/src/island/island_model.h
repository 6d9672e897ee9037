#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "island/island.h"
#include "island/joint_source.h"
#include "island/touch_memory.h"
#include "island/touched_faces.h"
#include "island/wrench.h"

/// \file
/// Data shared by the island's laws of motion. Private to coordination.
namespace tandem {

/// Factors of a body (IslandBody), relative to the largest. With S = diag(turn_root_W) a torque t
/// accelerates by S I^-1 S t: symmetric, so that no contact makes energy.
struct MassFactors {
  double linear = 1.0, angular = 1.0;  ///< largest factor; 1 if all are 0
  Vec3 way_W = Vec3::Ones(), turn_root_W = Vec3::Ones();
  bool way_is_even = true, turn_is_even = true;  ///< all are one: a body like any other

  [[nodiscard]] bool areEven() const noexcept { return way_is_even && turn_is_even; }
  /// The part of force or torque that can move the body.
  [[nodiscard]] Vec3 feltForce(const Vec3& f_W) const noexcept {
    return way_is_even ? f_W : keep(way_W, f_W);
  }
  [[nodiscard]] Vec3 feltTorque(const Vec3& t_W) const noexcept {
    return turn_is_even ? t_W : keep(turn_root_W, t_W);
  }

 private:
  [[nodiscard]] static Vec3 keep(const Vec3& shares, const Vec3& v) noexcept {
    return (shares.array() > 0.0).select(v, 0.0);
  }
};

/// A body with values derived from its settings, its present state and its external forces.
struct ModelBody {
  IslandBody settings;
  RigidState state;
  double inverse_mass = 0.0;              ///< along the freest axis; 0: not moved by forces [1/kg]
  Vec3 inverse_inertia_B = Vec3::Zero();  ///< times the largest factor; 0: does not rotate
  MassFactors factors;
  double bounding_radius = 0.0;
  double mobility = 0.0;  ///< upper bound of velocity per impulse at its surface [1/kg]
  Vec3 f_external_W = Vec3::Zero();
  Vec3 t_external_W = Vec3::Zero();
  bool is_slot = false;
  bool is_active = true;       ///< false: an empty slot
  bool is_asleep = false;      ///< at rest and left out: see Sleepers
  bool disturbed = true;       ///< an external value has changed since the last advance
  bool is_ghost = false;       ///< stays where it is set, and touches nothing
  bool has_tool = false;       ///< a hand that touches nothing: its tool does
  double contact_share = 1.0;  ///< share of its contacts' gains
  double extra_damping = 0.0;  ///< added to its own damping [N s/m]
  bool has_jumped = true;  ///< since the last advance it came, or was set where no motion led it

  /// Makes a body at its start state without external forces. Expects checked settings. A guided
  /// body does not rotate.
  [[nodiscard]] static ModelBody make(const IslandBody& settings, bool is_guided) noexcept;

  /// Takes mass, inertia, factors and damping of `changed`. Expects checked settings.
  void takeMass(const IslandBody& changed, bool is_guided) noexcept;

  /// Makes an empty slot, or the place of a body that was taken out.
  [[nodiscard]] static ModelBody makeEmpty(bool is_slot) noexcept;

  [[nodiscard]] bool isDynamic() const {
    return is_active && !is_ghost && settings.motion == Motion::kDynamic;
  }
  /// True if smooth contacts may act on it.
  [[nodiscard]] bool isTouchable() const { return is_active && !is_ghost && !has_tool; }
  [[nodiscard]] bool isPresent() const { return is_active && !is_asleep; }
  [[nodiscard]] double damping() const { return settings.damping + extra_damping; }
  [[nodiscard]] bool rotates() const { return inverse_inertia_B != Vec3::Zero(); }
  /// Equal moments about all axes: no gyroscopic torque.
  [[nodiscard]] bool isRound() const {
    const Vec3& i = settings.inertia_B;
    return i.x() == i.y() && i.y() == i.z();
  }
  /// Without torque its angular velocity stays.
  [[nodiscard]] bool turnsSteadily() const { return isRound() || !factors.turn_is_even; }
  /// Decay of its velocity by its own damping, which acts alike along all axes [1/s].
  [[nodiscard]] double decay() const { return damping() * inverse_mass / factors.linear; }
};

struct ModelCoupler {
  BodyIndex follower = 0;
  CouplerSettings settings;  ///< gains as added
  RigidState target;
  double share = 1.0;
  CouplerSettings now = settings;  ///< gains times the share
};

/// Room for a grip of one hand.
struct ModelGrip {
  BodyIndex hand = 0;
  bool is_on = false;
  IslandGrip hold;
};

/// The island as built, and lists of the bodies that take part now. Work of each tick loops over
/// present bodies only.
struct IslandModel {
  IslandSettings settings;
  std::vector<ModelBody> bodies;
  std::vector<ModelCoupler> couplers;
  std::vector<IslandContact> contacts;
  std::vector<ModelGrip> grips;
  std::vector<BodyIndex> slots;
  const std::vector<Obstacle>* obstacles = nullptr;
  ContactFinder* finder = nullptr;
  JointSource* joints = nullptr;
  bool joins_slots_only = false;  ///< the others' joints have acted already: IslandCatchUp
  TouchMemory memory;
  TouchedFaces faces;
  bool remembers_touches = true;  ///< Island::setTouchMemory()
  bool has_jumps = false;         ///< since the last advance some body or obstacle came or jumped
  bool has_arrivals = false;      ///< some obstacle came or moved, and no contact knows it yet

  /// True if a joint between two bodies acts in the present advance.
  [[nodiscard]] bool isJoinedNow(BodyIndex a, BodyIndex b) const noexcept {
    return !joins_slots_only || isIn(slots, a) || isIn(slots, b);
  }
  /// True if the filters of the two let them touch.
  [[nodiscard]] bool letsMeet(BodyIndex a, BodyIndex b) const noexcept {
    return bodies[a].settings.filter.meets(bodies[b].settings.filter);
  }

  /// Finds out whether a hand has a tool now.
  void noteTools(BodyIndex hand) noexcept {
    const bool has_tool = std::any_of(grips.begin(), grips.end(), [&](const ModelGrip& grip) {
      return grip.hand == hand && grip.is_on && grip.hold.is_tool;
    });
    is_listed = is_listed && bodies[hand].has_tool == has_tool;
    bodies[hand].has_tool = has_tool;
  }
  /// True if some grip holds the body.
  [[nodiscard]] bool isGripped(BodyIndex body) const noexcept {
    return std::any_of(grips.begin(), grips.end(),
                       [&](const ModelGrip& grip) { return grip.is_on && grip.hold.body == body; });
  }
  /// True if one of the two holds the other: they do not touch.
  [[nodiscard]] bool areJoined(BodyIndex a, BodyIndex b) const noexcept {
    return std::any_of(grips.begin(), grips.end(), [&](const ModelGrip& grip) {
      return grip.is_on &&
             ((grip.hand == a && grip.hold.body == b) || (grip.hand == b && grip.hold.body == a));
    });
  }

  std::vector<BodyIndex> present;               ///< active and awake bodies, in order
  std::vector<IslandContact> present_contacts;  ///< contacts between two present bodies
  std::vector<int> present_couplers;            ///< couplers of present bodies
  std::vector<int> present_grips;               ///< grips that pull, between two present bodies
  int asleep_count = 0;
  bool is_listed = false;  ///< the lists are up to date

  /// Share of the gains of a contact of two bodies.
  [[nodiscard]] double contactShare(BodyIndex a, BodyIndex b) const noexcept {
    return bodies[a].contact_share * bodies[b].contact_share;
  }
  /// The same with nothing lowered.
  [[nodiscard]] double fullContactShare(BodyIndex a, BodyIndex b) const noexcept {
    return bodies[a].settings.contact_share * bodies[b].settings.contact_share;
  }

  /// Reserves enough room that listPresent() never allocates.
  void reserveLists();
  void listPresent() noexcept;
  void wake(BodyIndex body) noexcept {
    is_listed = is_listed && !bodies[body].is_asleep;
    bodies[body].is_asleep = false;
  }

 private:
  [[nodiscard]] static bool isIn(const std::vector<BodyIndex>& list, BodyIndex body) noexcept {
    return std::find(list.begin(), list.end(), body) != list.end();
  }
};

/// Force and torque of a coupler on its follower.
[[nodiscard]] Wrench computeCouplerWrench(const ModelCoupler& coupler,
                                          const RigidState& follower) noexcept;

/// Torque of a body's angular damping, in W [N m].
[[nodiscard]] Vec3 computeAngularDamping(const IslandBody& body, const RigidState& state) noexcept;

/// Moves a pose along its own velocities for `dt` [s].
void goOn(RigidState& state, double dt) noexcept;

/// State of a prescribed or held body after `dt` [s].
[[nodiscard]] RigidState extrapolate(const ModelBody& body, double dt) noexcept;

}  // namespace tandem
