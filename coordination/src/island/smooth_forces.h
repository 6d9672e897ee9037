#pragma once

#include <vector>

#include "geometry/compound_parts.h"
#include "geometry/separation.h"
#include "island/grip_law.h"
#include "island/island_model.h"
#include "island/joint_forces.h"
#include "island/touch.h"

namespace tandem {

/// Forces on bodies in contact as a function of their state. It holds only what each stage of an
/// integration step needs.
///
/// The state of all movers is one vector. A mover has 6 values (p, v), or 14 (p, v, q, w and a
/// constant 0) if it rotates. Touched bodies that forces do not move follow p + v t.
class SmoothForces {
 public:
  static constexpr int kQ = 6,
                       kW = 10;  ///< offsets of orientation and angular velocity in a mover
  static constexpr std::size_t kMaxSize = 14;  ///< values of a mover that rotates

  /// Most integration steps in a haptic period, for any stiffness. Most time constants by which a
  /// speed may decay in one step.
  static constexpr double kMostStepsPerPeriod = 4096, kDecayPerStep = 0.8;

  /// Touches that an evaluation includes.
  enum class Look {
    kPushing,  ///< pushing touches, only for their force
    kAll,      ///< all touches; measures them
    kDecide,   ///< all touches; measures them and decides which push from now on
  };

  /// A touch and its last measured values.
  struct Contact {
    int sphere = 0, other = 0;  ///< frames
    double radius = 0.0;        ///< of the sphere, less the allowance [m]
    const Shape* shape = nullptr;
    const CompoundParts::Part* part = nullptr;  ///< of the other's compound, which has `shape`
    int piece = -1;                             ///< triangle of a mesh
    CouplerGains gains;
    double guard_scale = 0.0;  ///< converts a force to an overlap [N/m]
    bool pushes = false;       ///< pushes over the present step
    double overlap = 0.0;      ///< [m]
    double rate = 0.0;         ///< rate of the overlap [m/s]
    double guard = 0.0;        ///< positive exactly while the contact stays in its pushing mode [m]
    /// Separation::face through which an inside centre leaves over the present step; -1 if none. A
    /// change makes the force jump: an event.
    int face = -1;
    int entered = -1;  ///< face at the last measured state
    int touched = -1;  ///< face, or triangle of a mesh, that the sphere has touched
    int under = -1;    ///< Separation::under at the last measured state
  };

  /// A body that is integrated.
  struct Mover {
    BodyIndex body = 0;
    int offset = 0;  ///< offset of its values in the state vector
    bool turns = false;
    bool needs_rotation = false;  ///< its orientation matters beyond couplers
    bool is_round = false;        ///< equal moments about all axes: no gyroscopic torque
    double inverse_mass = 0.0, stiffness = 0.0, damping = 0.0;
    PlainVec p_rest, f_rest_W;  ///< force = f_rest + f_held(t) + stiffness (p_rest - p) - damping v
    PlainVec inertia_B, inverse_inertia_B, t_rest_W;
    PlainVec f_held_W, t_held_W;            ///< at time 0
    PlainVec f_held_rate_W, t_held_rate_W;  ///< [N/s], [N m/s]
    double turn_damping = 0.0;              ///< sum over couplers [N m s/rad]
    double turn_rate = 0.0;                 ///< IslandBody::angular_damping [1/s]
    double radius = 0.0;                    ///< bounding radius [m]
    const MassFactors* factors = nullptr;   ///< null: even
    double decay = 0.0;                     ///< with factors: of its velocity by own damping [1/s]
  };

  /// Allocates.
  SmoothForces(const IslandModel& model, std::size_t max_touches, JointForces& joints);

  /// Selects the bodies and touches for the coming steps, after JointForces::choose(). A body that
  /// is `alone` only rotates.
  void choose(const IslandModel& model, const std::vector<char>& together,
              const std::vector<char>& alone, const std::vector<Touch>& touches) noexcept;

  /// Sets extra forces that change evenly from load() on, by body, in W; replaces earlier ones.
  void hold(const std::vector<HeldWrench>& held) noexcept;

  /// Restarts the clock of driven bodies and copies the movers' state to `y`.
  void load(const States& states, double* y) noexcept;
  /// Copies the movers' state from `y`.
  void store(const double* y, States& states) const noexcept;

  /// Computes the rates `k` of the state `y` at time `t` [s] since load(). A push is not clipped at
  /// zero, so that forces stay smooth inside a step; the step ends where the mode would change.
  void evaluate(double t, const double* y, double* k, Look look) noexcept;

  /// Accepts the last measured step: centres may have entered or left through a face.
  void acceptFaces() noexcept;

  /// True if a coupled body passed half a turn in the last measured step.
  [[nodiscard]] bool hasTurnedOver() const noexcept;

  [[nodiscard]] int size() const noexcept { return size_; }
  [[nodiscard]] bool hasJoints() const noexcept { return !joints_.isEmpty(); }
  [[nodiscard]] const std::vector<Mover>& movers() const noexcept { return movers_; }
  [[nodiscard]] const std::vector<Contact>& contacts() const noexcept { return contacts_; }

 private:
  /// Pose, velocities and forces of a body or obstacle during an evaluation.
  struct Frame {
    PlainVec p, v, w;
    PlainRotation R_WB;
    PlainVec f_W, t_W;
  };
  /// A touched body that forces do not move.
  struct Driven {
    BodyIndex body;
    int frame;
    bool goes_on;
    bool turns = false;
    PlainVec p, rate;
    Quat q_WB = Quat::Identity();
  };
  struct TurnSpring {
    int mover;
    double stiffness;
    double target[4];
    /// Direction of rotation over the present step. At half a turn the torque reverses; a step
    /// across would create energy.
    double side = 1.0;
    double side_now = 1.0;  ///< shorter direction at the last measured state
  };

  /// A grip of a hand (IslandGrip).
  struct Pull {
    int hand = 0, body = 0;  ///< frames
    GripLaw law;
    double target[4];
    bool turns = false;
    double side = 1.0, side_now = 1.0;  ///< as in TurnSpring
  };

  void addMover(const IslandModel& model, BodyIndex body, bool is_alone) noexcept;
  void tieCouplers(const IslandModel& model) noexcept;
  [[nodiscard]] int findFrame(const IslandModel& model, BodyIndex body) noexcept;
  void addContact(const IslandModel& model, const Touch& touch) noexcept;
  void addPull(const IslandModel& model, const ModelGrip& grip) noexcept;
  void pull(Pull& pull, const double* y, Look look) noexcept;
  [[nodiscard]] double limitDamping(double damping, double mobility) const noexcept;
  void placeFrames(double t, const double* y) noexcept;
  [[nodiscard]] static Separation separate(const Contact& contact, const PlainVec& c_B,
                                           Look look) noexcept;
  void push(Contact& contact, Look look) noexcept;
  void computeRates(const double* y, double* k) const noexcept;
  void join(double t, const double* y, double* k) noexcept;
  static void accelerateByFactors(const Mover& mover, const Frame& frame, double* rates) noexcept;
  [[nodiscard]] static PlainVec turnByFactors(const Mover& mover, const Frame& frame) noexcept;

  double period_;
  JointForces& joints_;
  int size_ = 0;
  std::vector<Mover> movers_;  ///< frames_ starts with their frames, in the same order
  std::vector<TurnSpring> springs_;
  std::vector<Driven> driven_;
  std::vector<Contact> contacts_;
  std::vector<Pull> pulls_;
  std::vector<Frame> frames_;
  std::vector<int> frame_of_;  ///< by body; -1: none
};

}  // namespace tandem
