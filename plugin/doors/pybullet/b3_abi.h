#pragma once

#include <cstddef>

// Binary interface between PyBullet's physics server and its plugins; none of its headers is used.
// The layouts hold for the magic number below, in use since PyBullet 3.07 (October 2020). A server
// with another number refuses the plugin.

namespace tandem::pybullet::b3 {

/// Return value of initPlugin: the version of the layouts.
inline constexpr int kMagicNumber = 202010061;

// Opaque to a plugin.
using Client = struct ClientHandle*;
using Command = struct CommandHandle*;
using Status = struct StatusHandle*;

/// Bytes that a command returns to the caller.
struct UserDataValue {
  int type;
  int length;
  const char* data;
};
inline constexpr int kBytes = 0;
inline constexpr int kString = 1;

/// Argument of each call into a plugin. The first initPlugin() sets only the first two members and
/// the last one. In ticks all members without a value are 0.
struct PluginContext {
  Client client;  // of the server itself, private to plugins
  void* user_pointer;
  UserDataValue* return_data;
  const void* controller_events;
  int controller_event_count;
  const void* key_events;
  int key_event_count;
  const void* mouse_events;
  int mouse_event_count;
  const void* notifications;
  int notification_count;
  void* command_processor;
};

/// Arguments of executePluginCommand(). The floats are rounded to single precision.
struct PluginArguments {
  char text[1024];
  int int_count;
  int ints[128];
  int float_count;
  double floats[128];
};

/// Answer about the dynamics of a link. Members that a kind of body lacks hold an old value;
/// `later` is room for members of newer versions.
struct DynamicsInfo {
  double mass;
  double inertia[3];
  double inertial_frame[7];
  double friction;
  double rolling_friction;
  double spinning_friction;
  double restitution;
  double contact_stiffness;
  double contact_damping;
  int activation_state;
  int body_type;
  double angular_damping;
  double linear_damping;
  double swept_sphere_radius;
  double contact_threshold;  // of a multibody: larger distances make no contact constraint [m]
  char later[496];
};
inline constexpr int kRigidBody = 1;  // body_type: a btRigidBody ("maximal coordinates")
inline constexpr int kMultiBody = 2;
inline constexpr int kSoftBody = 3;
inline constexpr int kNeverSleeps = 4;  // activation_state

/// Activation bits of the change-dynamics command, which differ from those in DynamicsInfo.
inline constexpr int kEnableSleeping = 1;
inline constexpr int kDisableSleeping = 2;

/// Answer about the simulation's parameters; see DynamicsInfo for `later`.
struct SimulationParameters {
  double time_step;
  double timestamp;
  double gravity[3];
  int substeps;
  int solver_iterations;
  double warm_starting;
  double articulated_warm_starting;
  int real_time;
  char later[1024];
};

/// One piece of a body's collision shape.
struct CollisionShapeData {
  int body;
  int link;
  int geometry;
  double dimensions[3];
  double frame[7];  // in the frame of the link's centre of mass: position, quaternion
  char mesh_file[1024];
};
struct CollisionShapeInformation {
  int count;
  CollisionShapeData* pieces;
};

// CollisionShapeData::geometry
inline constexpr int kSphere = 2;    // dimensions: radius
inline constexpr int kBox = 3;       // edges
inline constexpr int kCylinder = 4;  // height, radius; along z
inline constexpr int kMesh = 5;
inline constexpr int kPlane = 6;    // normal
inline constexpr int kCapsule = 7;  // distance of the spheres' centres, radius; along z

static_assert(sizeof(PluginContext) == 96 && offsetof(PluginContext, command_processor) == 88);
static_assert(offsetof(PluginArguments, floats) == 1544);
static_assert(offsetof(DynamicsInfo, linear_damping) == 152);
static_assert(offsetof(DynamicsInfo, contact_threshold) == 168);
static_assert(offsetof(SimulationParameters, real_time) == 64);
static_assert(sizeof(CollisionShapeData) == 1120);

}  // namespace tandem::pybullet::b3
