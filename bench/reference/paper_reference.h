#pragma once

#include <array>
#include <vector>

#include "bench/reference/sampling.h"
#include "bench/reference/spring_damper.h"

namespace tandem::reference {

/// Task of the two users.
enum class Experiment {
  kCooperativeManipulation,  ///< Experiment I: they move a cube between them
  kUserContact,              ///< Experiment II: they push each other, there is no cube
};

/// Representation of the remote user at a site.
enum class Scheme {
  kVirtualCoupling,     ///< none: users interact only through the cube, so Experiment II is free
                        ///< motion
  kKinematicProxy,      ///< a body with the user's delayed position and velocity
  kRemoteDynamicProxy,  ///< a body with the user's mass, coupled to the delayed user
};

/// All parameters of a run of the paper's one-axis model. The letters are the paper's.
struct PaperParameters {
  Experiment experiment = Experiment::kCooperativeManipulation;
  Scheme scheme = Scheme::kRemoteDynamicProxy;
  HipMotion hip_motion = HipMotion::kExtrapolated;

  double hand_force_1 = 5.0;               ///< F_h1 [N], along +x
  double hand_force_2 = 0.0;               ///< F_h2 [N], along +x
  SpringDamper contact{4000.0, 1.0};       ///< K_vc [N/m], B_vc [N s/m], of every contact
  SpringDamper coordination{200.0, 30.0};  ///< K_t [N/m], B_t [N s/m]
  double object_mass = 0.2;                ///< m [kg], the whole cube: each copy carries half
  double object_damping = 0.0;             ///< b [N s/m], of each copy
  double proxy_mass = 0.1;                 ///< m_h [kg], of an RDP and of the device it stands for
  double proxy_damping = 0.0;              ///< b_h [N s/m], of an RDP
  double device_damping = 0.5;             ///< b_dev [N s/m]
  Sampling sampling{};                     ///< rates, T_d and duration
  double step = 2e-6;                      ///< longest step of the integrator [s]
};

/// The paper's Experiment I (1 s, 50 ms delay).
[[nodiscard]] PaperParameters makeCooperativeManipulation(Scheme scheme);

/// The paper's Experiment II (2 s, 100 ms delay, contacts of 2000 N/m).
[[nodiscard]] PaperParameters makeUserContact(Scheme scheme);

/// State at a tick, before its haptic period. Positions are displacements from the start along +x
/// [m]. Values that a scheme or an experiment lacks stay 0.
struct PaperRow {
  double t = 0.0;             ///< [s]
  double x1 = 0.0;            ///< device 1
  double x2 = 0.0;            ///< device 2
  double v1 = 0.0;            ///< velocity of device 1 [m/s]
  double v2 = 0.0;            ///< velocity of device 2 [m/s]
  double xo1 = 0.0;           ///< cube at site 1
  double xo2 = 0.0;           ///< cube at site 2
  double x12 = 0.0;           ///< proxy of user 1 at site 2
  double x21 = 0.0;           ///< proxy of user 2 at site 1
  double received_xo2 = 0.0;  ///< cube of site 2 as received at site 1
  double received_xo1 = 0.0;  ///< cube of site 1 as received at site 2
  double force_1 = 0.0;       ///< contact force on device 1 in this period, along +x [N]: -F_vc1
  double force_2 = 0.0;       ///< contact force on device 2 in this period, along +x [N]: +F_vc2
};

/// Results over all rows of a run. Arrays hold site 1, then site 2.
struct PaperSummary {
  double coherency_mean = 0.0;               ///< mean |xo1 - xo2| at equal time [m]
  double coherency_max = 0.0;                ///< [m]
  std::array<double, 2> received_mean{};     ///< mean |own cube - other cube as received| [m]
  std::array<int, 2> contact_transitions{};  ///< on/off changes, counted from off
  std::array<double, 2> force_max{};         ///< largest |force| on the device [N]
  std::array<double, 2> force_mean{};        ///< mean |force| on the device [N]
  std::array<double, 2> device_end{};        ///< displacement at t = duration [m]
};

struct PaperResult {
  std::vector<PaperRow> rows;  ///< tick k at k / haptic_rate, k = 0 .. N-1
  PaperSummary summary;
};

/// Integrates eqs (1)-(14) of Li & Constantinescu 2009 from rest, just in contact.
///
/// Signs are consistent: every force acts with its opposite on the other body. The device holds the
/// contact force of its tick for one haptic period. Packets leave at n / packet_rate, arrive
/// `delay` later and are held until the next. Between these instants the smooth system is
/// integrated by Runge-Kutta 4. A step in which a contact begins or ends is halved until this is
/// located. Throws std::invalid_argument on invalid masses, step or sampling.
[[nodiscard]] PaperResult runPaperModel(const PaperParameters& parameters);

}  // namespace tandem::reference
