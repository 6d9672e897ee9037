#pragma once

#include <vector>

#include "island/island_model.h"
#include "geometry/plain_vec.h"
#include "island/touch.h"

namespace tandem {

/// The forces on bodies in touch as a function of their state, in compact form: what is needed at
/// every stage of an integration step and nothing else.
///
/// The state of all movers is one vector; each has 6 values (p, v), or 14 (p, v, q, w and one that
/// is always 0) if it turns. Touched bodies that forces do not move go on at p + v t.
class SmoothForces {
 public:
  static constexpr int kQ = 6,
                       kW = 10;  ///< where orientation and turning begin in a mover's values
  static constexpr std::size_t kMaxSize = 14;  ///< values of a mover that turns

  /// Steps that an integrator may make of a haptic period at the most, however stiff; and how far a
  /// speed may decay in a step, in its time constants.
  static constexpr double kMostStepsPerPeriod = 4096, kDecayPerStep = 0.8;

  /// Which touches an evaluation looks at.
  enum class Look {
    kPushing,  ///< those that push, only for their force
    kAll,      ///< all, measured besides
    kDecide,   ///< all, measured, and they push from now on if they do so here
  };

  /// A touch, and how it stood when last measured.
  struct Contact {
    int sphere = 0, other = 0;  ///< frames
    double radius = 0.0;        ///< of the sphere [m]
    const Shape* shape = nullptr;
    int piece = -1;  ///< of a mesh
    CouplerGains gains;
    double guard_scale = 0.0;  ///< of a push, to be compared with an overlap [N/m]
    bool pushes = false;       ///< over the present step
    double overlap = 0.0;      ///< [m]
    double rate = 0.0;         ///< of the overlap [m/s]
    double guard = 0.0;        ///< positive exactly while the contact pushes as it does [m]
    /// Separation::face by which a sphere with its centre inside leaves over the present step; -1
    /// if none. At the next one the force jumps: an event.
    int face = -1;
    int entered = -1;  ///< the same at the state last measured
  };

  /// A body that is integrated.
  struct Mover {
    BodyIndex body = 0;
    int offset = 0;  ///< of its values in the state vector
    bool turns = false;
    bool needs_rotation = false;  ///< something looks at its orientation besides couplers
    bool is_round = false;        ///< equal moments about all axes: no gyroscopic torque
    double inverse_mass = 0.0, stiffness = 0.0, damping = 0.0;
    PlainVec p_rest, f_rest_W;  ///< force = f_rest + f_held + stiffness (p_rest - p) - damping v
    PlainVec inertia_B, inverse_inertia_B, t_rest_W;
    PlainVec f_held_W, t_held_W;
    double turn_damping = 0.0;  ///< of couplers [N m s/rad]
    double turn_rate = 0.0;     ///< IslandBody::angular_damping [1/s]
    double radius = 0.0;        ///< of a ball around it [m]
  };

  /// Allocates.
  explicit SmoothForces(const IslandModel& model, std::size_t max_touches);

  /// From now on about these bodies and touches. A body that is `alone` only turns.
  void choose(const IslandModel& model, const std::vector<char>& together,
              const std::vector<char>& alone, const std::vector<Touch>& touches) noexcept;

  /// Constant forces on top, by body, in W; replaces those held before.
  void hold(const std::vector<Wrench>& held) noexcept;

  /// Starts the clock of what forces do not move, and takes the movers' state.
  void load(const States& states, double* y) noexcept;
  /// Gives the movers' state back.
  void store(const double* y, States& states) const noexcept;

  /// Rates `k` of the state `y` at the time `t` [s] since load(). A push is not clipped at zero:
  /// the law stays smooth inside a step, which ends where it would change.
  void evaluate(double t, const double* y, double* k, Look look) noexcept;

  /// The step that was measured last was taken: a centre may have come in through a face, or out.
  void acceptFaces() noexcept;

  /// A body that couplers turn went past halfway round in the step that was measured last.
  [[nodiscard]] bool hasTurnedOver() const noexcept;

  [[nodiscard]] int size() const noexcept { return size_; }
  [[nodiscard]] const std::vector<Mover>& movers() const noexcept { return movers_; }
  [[nodiscard]] const std::vector<Contact>& contacts() const noexcept { return contacts_; }

 private:
  /// Where a body or obstacle is at the time of an evaluation, and what acts on it.
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
    /// Way round over the present step: halfway round the torque jumps to the other way, and a step
    /// across that would make energy.
    double side = 1.0;
    double side_now = 1.0;  ///< the shorter one at the state last looked at
  };

  void addMover(const IslandModel& model, BodyIndex body, bool is_alone) noexcept;
  void tieCouplers(const IslandModel& model) noexcept;
  [[nodiscard]] int findFrame(const IslandModel& model, BodyIndex body) noexcept;
  void addContact(const IslandModel& model, const Touch& touch) noexcept;
  [[nodiscard]] double limitDamping(double damping, double mobility) const noexcept;
  void placeFrames(double t, const double* y) noexcept;
  void push(Contact& contact, Look look) noexcept;
  void computeRates(const double* y, double* k) const noexcept;

  double period_;
  int size_ = 0;
  std::vector<Mover> movers_;  ///< their frames are the first, in the same order
  std::vector<TurnSpring> springs_;
  std::vector<Driven> driven_;
  std::vector<Contact> contacts_;
  std::vector<Frame> frames_;
  std::vector<int> frame_of_;  ///< by body; -1: none
};

}  // namespace tandem
