#pragma once

#include <string>

#include "b3_abi.h"

namespace tandem::pybullet {

/// Functions of PyBullet's C interface, found at run time. The plugin is not linked to PyBullet, so
/// one file serves all versions.
struct B3Functions {
  b3::Status (*submit)(b3::Client, b3::Command) = nullptr;

  b3::Command (*make_state_request)(b3::Client, int body) = nullptr;
  int (*get_state)(b3::Status, int* body, int* q_count, int* u_count, const double** frame,
                   const double** q, const double** u, const double** reactions) = nullptr;
  int (*get_state_and_links)(b3::Status, int* body, int* links, int* q_count, int* u_count,
                             const double** frame, const double** q, const double** u,
                             const double** reactions, const double** link_frames,
                             const double** motor_forces, const double** link_states,
                             const double** link_velocities) = nullptr;

  b3::Command (*make_pose)(b3::Client, int body) = nullptr;
  int (*set_position)(b3::Command, double x, double y, double z) = nullptr;
  int (*set_orientation)(b3::Command, double x, double y, double z, double w) = nullptr;
  int (*set_velocity)(b3::Command, const double velocity[3]) = nullptr;
  int (*set_angular_velocity)(b3::Command, const double velocity[3]) = nullptr;

  b3::Command (*make_dynamics_request)(b3::Client, int body, int link) = nullptr;
  int (*get_dynamics)(b3::Status, b3::DynamicsInfo*) = nullptr;
  b3::Command (*make_dynamics_change)(b3::Client) = nullptr;
  int (*change_mass)(b3::Command, int body, int link, double mass) = nullptr;
  int (*change_inertia)(b3::Command, int body, int link, const double inertia[3]) = nullptr;
  int (*change_linear_damping)(b3::Command, int body, double damping) = nullptr;
  int (*change_angular_damping)(b3::Command, int body, double damping) = nullptr;
  int (*change_friction)(b3::Command, int body, int link, double friction) = nullptr;
  int (*change_restitution)(b3::Command, int body, int link, double restitution) = nullptr;
  int (*change_contact_threshold)(b3::Command, int body, int link, double distance) = nullptr;
  int (*change_activation)(b3::Command, int body, int bits) = nullptr;

  b3::Command (*make_parameter_request)(b3::Client) = nullptr;
  int (*get_parameters)(b3::Status, b3::SimulationParameters*) = nullptr;

  b3::Command (*make_shape_request)(b3::Client, int body, int link) = nullptr;
  void (*get_shape)(b3::Client, b3::CollisionShapeInformation*) = nullptr;

  b3::Command (*make_filter)(b3::Client) = nullptr;
  void (*set_pair)(b3::Command, int body_a, int body_b, int link_a, int link_b,
                   int collides) = nullptr;
};

/// Finds all functions in the module that contains the code at `caller`: PyBullet's, or a program
/// that exports them. Python loads PyBullet with local symbols, so the loader does not find them.
/// Returns "", or the name of the first missing function.
std::string findB3Functions(const void* caller, B3Functions& functions);

}  // namespace tandem::pybullet
