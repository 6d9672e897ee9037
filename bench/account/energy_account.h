#pragma once

#include <cstdint>
#include <vector>

#include "coordination/src/geometry/contact_geometry.h"
#include "coordination/src/island/island.h"

namespace tandem::demos::bench {

/// Facts about a scene that an account needs besides the island.
struct AccountScene {
  Vec3 gravity_W = Vec3::Zero();  ///< acts on shared objects and the host's bodies [m/s^2]
  Vec3 origin_W = Vec3::Zero();   ///< place with zero potential of weight
  bool is_free = true;            ///< the host's world has no fixed bodies
  bool has_overlap = false;       ///< rigid bodies may overlap at the start, or on entry
  CouplerGains contact;           ///< gains of all smooth contacts
  std::optional<Vec3> guide;      ///< guide of the island
  double haptic_period = 1e-3;    ///< [s]
};

/// Energy by its form [J].
struct EnergyStock {
  double motion = 0.0;    ///< kinetic, of all bodies that forces move
  double couplers = 0.0;  ///< energy of springs to targets
  double contacts = 0.0;  ///< energy of springs of overlapping pairs
  double weight = 0.0;    ///< potential; may be negative

  [[nodiscard]] double sum() const { return motion + couplers + contacts + weight; }
};

/// Energy that came in from outside so far [J].
struct EnergyFlows {
  double target_jumps = 0.0;   ///< coupler springs stretched by new targets, the hand's samples
                               ///< jumping, bodies coming and going
  double target_motion = 0.0;  ///< dampers dragged by held targets, by their velocity
  double hand = 0.0;           ///< the haptic interface point pushing through contacts
  double host = 0.0;           ///< all changes during the host's steps
  double push_out = 0.0;       ///< rigid bodies moved out of overlap, without a velocity

  [[nodiscard]] double sum() const { return target_jumps + target_motion + hand + host + push_out; }
};

/// An account at one moment.
struct AccountRow {
  double time = 0.0;  ///< [s]
  EnergyStock stock;
  EnergyFlows flows;
  double lost = 0.0;  ///< energy lost so far [J]
};

/// Follows the mechanical energy of an island from outside, using only the states of its bodies at
/// any number of moments:
///
///   lost = E(0) + W - E(t)     must never fall
///
/// E is kinetic energy, weight and the springs of couplers and contacts. W is the energy input:
///
/// - between two looks at the same time every change came from outside. The whole difference is
///   work (a target that jumps by d under a coupler K: K d . (p_new - p) ...);
/// - a target is held, but its velocity v_t counts in the damper: B (|v_t|^2 dt - v_t . dp), exact;
/// - the haptic interface point moves evenly in a tick. Its work is the law of contact times its
///   velocity, integrated along both ways (BetweenLooks). At kinks of these the bodies' momentum
///   also gives the work, and the difference is doubt();
/// - rigid contact shifts bodies out of overlap without a velocity. The work is the energy that
///   springs and weight gain by the shift.
///
/// Dissipation is not estimated: dampers, friction and impacts can only make `lost` grow.
class EnergyAccount {
 public:
  /// Both must outlive the account.
  EnergyAccount(const Island& island, const AccountScene& scene);

  /// Records the island's state at `time` [s], not earlier than at the last look.
  void look(double time);
  /// The same at the end of a host step, during which no time passes in the island.
  void lookAfterHost(double time);

  /// Appends the result of each look to `rows`; null stops this.
  void setTrace(std::vector<AccountRow>* rows) { trace_ = rows; }

  /// Number of looks in the coming tick that the hand's work needs: 1 to `most`.
  [[nodiscard]] int countLooks(int most) const;

  [[nodiscard]] const EnergyStock& stock() const { return stock_; }
  [[nodiscard]] const EnergyStock& startStock() const { return start_; }
  [[nodiscard]] const EnergyFlows& flows() const { return flows_; }
  /// Largest fall of the lost energy: energy without a source [J].
  [[nodiscard]] double unaccounted() const { return unaccounted_; }
  /// Time at which that largest fall occurred [s].
  [[nodiscard]] double unaccountedTime() const { return unaccounted_time_; }
  /// Largest energy that took part [J].
  [[nodiscard]] double peak() const { return peak_; }
  /// Possible error of the hand's work, and of integrator steps across an edge [J].
  [[nodiscard]] double doubt() const { return doubt_; }
  /// Work of all shifts out of overlap, each without its sign [J].
  [[nodiscard]] double shifted() const { return shifted_; }
  /// Possible rounding by coordinates [J].
  [[nodiscard]] double rounding() const { return rounding_; }
  /// True while every number has been finite.
  [[nodiscard]] bool isFinite() const { return finite_; }
  /// Largest way of a body between two looks, beyond the limit of its speed [m].
  [[nodiscard]] double worstJump() const { return worst_jump_; }
  [[nodiscard]] double worstJumpTime() const { return worst_jump_time_; }
  /// Spring energy that appeared in contacts while the host stepped [J].
  [[nodiscard]] double hostContactEnergy() const { return host_contact_energy_; }
  [[nodiscard]] std::uint64_t looks() const { return looks_; }

 private:
  /// State of a smooth contact.
  struct Pair {
    BodyIndex sphere = 0,
              other = 0;  ///< sphere and other body; an obstacle's pair has the sphere twice
    const Obstacle* obstacle = nullptr;  ///< null: the other is a body
    double overlap = 0.0, rate = 0.0;
    Vec3 n_W = Vec3::Zero();  ///< towards the sphere; zero while their bounding balls are apart
  };
  struct Snapshot {
    double time = 0.0;
    std::vector<RigidState> states;
    std::vector<char> active;
    std::vector<Pair> pairs;
  };
  /// A body's displacement beyond that of its velocity.
  struct Shift {
    Vec3 way_W = Vec3::Zero(), turn_W = Vec3::Zero();
  };
  /// Result of a contact between two looks, with and without push.
  struct Pushed {
    double spring = 0.0;   ///< work of the closing motion against the spring [J]
    double closing = 0.0;  ///< growth of the overlap [m]
    double time = 0.0;     ///< time of the push [s]
    double free = 0.0;     ///< energy gain of its spring without push [J]
  };

  void take(double time);
  void finishLook();
  void findPairs();
  void measure(Pair& pair) const;
  void measure(const RigidState& sphere, const RigidState& other, Pair& pair) const;
  void measureInSlot(const RigidState& sphere, const RigidState& other, Pair& pair) const;
  void measureStock();
  void addJump(double& flow);
  void addMotion();
  [[nodiscard]] double workOfTargets(double dt) const;
  [[nodiscard]] double workOfShifts(double dt);
  [[nodiscard]] std::vector<RigidState> findUnshifted(double dt);
  [[nodiscard]] double computePotential(const std::vector<RigidState>& states) const;
  [[nodiscard]] double workOfDriven(double dt);
  [[nodiscard]] Vec3 impulseOfHand(double dt) const;
  [[nodiscard]] double fastestOf(BodyIndex body, const Vec3& v_driver_W) const;
  [[nodiscard]] double integrateHand(const Pair& from, BodyIndex driver, double dt) const;
  [[nodiscard]] Pushed integratePush(const Pair& from, const Pair& to, double dt,
                                     const Vec3& v_closing_W, double held) const;
  [[nodiscard]] static bool isOverEdge(const Pair& from, const Pair& to);
  [[nodiscard]] double doubtOverEdge(const Pair& from, const Pair& to, double dt) const;
  [[nodiscard]] double innerRate() const;
  [[nodiscard]] double neededRate(BodyIndex driver, BodyIndex touched) const;
  void checkWays(double dt);
  void noteJump(double way);
  [[nodiscard]] bool isBlocked(const IslandContact& contact) const;
  [[nodiscard]] bool movesAny(const Pair& pair) const;

  const Island& island_;
  const AccountScene& scene_;
  std::vector<RigidState> origins_;  ///< origins of a guided island's bodies
  Snapshot now_, last_;
  std::vector<Shift> shifts_;  ///< since the last look
  std::uint64_t rigid_points_ = 0;
  EnergyStock stock_, start_, last_stock_;
  EnergyFlows flows_;
  double lost_ = 0.0, most_lost_ = 0.0;
  double unaccounted_ = 0.0, unaccounted_time_ = 0.0;
  double peak_ = 0.0, rounding_ = 0.0, doubt_ = 0.0;
  double shifted_ = 0.0;
  double worst_jump_ = 0.0, worst_jump_time_ = 0.0;
  double host_contact_energy_ = 0.0;
  bool finite_ = true;
  bool started_ = false;
  std::uint64_t looks_ = 0;
  std::vector<AccountRow>* trace_ = nullptr;
};

}  // namespace tandem::demos::bench
