#ifndef TANDEM_TANDEM_H
#define TANDEM_TANDEM_H

/* Tandem's C interface, with everything that a binding of another language needs. C99, and C++.

   A *world* is a Bullet world: the host's own, or one of Tandem's. A *device* is a hand, a
   *link* the way to one remote user. A *site* joins them: share bodies, connect remotes, step. A
   host without Bullet, or with a hidden Bullet world, creates a world of Tandem's. It adds the
   shared bodies as *guests*, and asks before and after each of its steps what to do with them:
   tandem_world_begin_step().

   Conventions. SI units. Right-handed world frame W. Quaternions are x, y, z, w. Arrays belong
   to the caller, and are read or written during the call only. Strings are UTF-8 and end with 0.
   Handles are created and destroyed by functions of their name; destroying a null handle does
   nothing.

   Errors. Functions that can fail return TandemResult. On failure they change and write nothing,
   and tandem_last_error() gives the reason in one line. No exception leaves a function. A handle
   that another one still uses is not destroyed (TANDEM_IN_USE): destroy sites first, then
   worlds, devices, links, meshes. A null handle, one of another kind and one that was destroyed
   lately are refused.

   Threads, stated at each function:

   - [any]: from any thread at any time.

   - [setup]: one thread at a time for all handles that a site joins. Not while a loop runs,
   except tandem_site_stop_loop() and tandem_site_warnings().

   - [host]: the thread that steps the world. It may differ from the [setup] thread, but not at
   the same time. Also allowed with a loop.

   - [tick]: the thread that ticks the site: [host], unless tick_source is TANDEM_TICK_CALLER.

   - [carry]: the thread that carries packets: [tick]. With a loop, any one other thread from the
   loop's start to its end.

   Sites of different worlds are independent; each may have its own threads. */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#pragma GCC visibility push(default)
#endif

/* --- Results ----------------------------------------------------- */

typedef enum TandemResult {
  TANDEM_OK = 0,
  TANDEM_INVALID_ARGUMENT = 1, /* a value out of range, or a null that is not allowed */
  TANDEM_CANNOT = 2,           /* set-up that cannot work, such as a shape that cannot be shared */
  TANDEM_WRONG_BULLET = 3,     /* other scalar width or version of Bullet than the library's */
  TANDEM_IN_USE = 4,           /* another handle still needs this one */
  TANDEM_WORLD_GONE = 5,       /* the host has destroyed its world; destroy the site */
  TANDEM_NO_MEMORY = 6,
  TANDEM_INTERNAL = 7 /* a bug in Tandem */
} TandemResult;

/* Name of a result: "TANDEM_IN_USE". [any] */
const char* tandem_result_name(TandemResult result);

/* Reason of this thread's latest failed call, in one line with the value and the remedy; ""
   before the first. Valid until the next failure in this thread. [any] */
const char* tandem_last_error(void);

/* Version of the loaded library: "0.1.0". [any] */
const char* tandem_version(void);

/* Size of btScalar in the library's Bullet [bytes]: 4 or 8. [any] */
size_t tandem_scalar_bytes(void);

/* --- Values ------------------------------------------------------ */

/* Pose of the centre of mass and its velocities, in W. */
typedef struct TandemState {
  double position[3];         /* [m] */
  double orientation[4];      /* x, y, z, w; unit length */
  double velocity[3];         /* [m/s] */
  double angular_velocity[3]; /* [rad/s] */
} TandemState;

typedef struct TandemGains {
  double stiffness; /* [N/m], or [N m/rad] */
  double damping;   /* [N s/m], or [N m s/rad] */
} TandemGains;

/* --- Worlds ------------------------------------------------------ */

typedef struct TandemWorld TandemWorld;

/* A body of a world. In a world of Tandem's no number is used twice; in a host's world it stands
   for the body's address. */
typedef uint32_t TandemBody;
#define TANDEM_NO_BODY 0u

/* Creates a world of Tandem's, empty and without gravity. [setup] */
TandemResult tandem_world_create(TandemWorld** world);

/* Attaches to the host's btDiscreteDynamicsWorld. For a derived class pass its address as that
   base. `scalar_bytes` and `bullet_version` are the host's sizeof(btScalar) and
   BT_BULLET_VERSION, so that a mismatch is refused; in C++ use TANDEM_ATTACH_ABI. The world
   should outlive the handle. [setup] */
TandemResult tandem_world_attach(void* discrete_dynamics_world, size_t scalar_bytes,
                                 int bullet_version, TandemWorld** world);
#define TANDEM_ATTACH_ABI sizeof(btScalar), BT_BULLET_VERSION

/* Fails while the world has a site. [setup] */
TandemResult tandem_world_destroy(TandemWorld* world);

/* [host] */
TandemResult tandem_world_set_gravity(TandemWorld* world, const double gravity[3]);

typedef enum TandemShapeKind {
  TANDEM_BOX = 0,    /* size: half extents */
  TANDEM_SPHERE = 1, /* size[0]: radius */
  TANDEM_CAPSULE =
      2, /* size[0]: radius, size[1]: distance of its spheres' centres; along z of the body */
  TANDEM_CYLINDER = 3, /* size[0]: radius, size[1]: whole height; along z of the body */
  TANDEM_HULL = 4,     /* convex hull of `points` */
  TANDEM_PLANE = 5,    /* all below z = 0 of the body; needs mass 0 */
  TANDEM_CONE = 6      /* size[0]: radius, size[1]: whole height; tip up z, the origin half-way */
} TandemShapeKind;

typedef struct TandemBodySettings {
  int internal; /* set by tandem_default_body_settings() */
  TandemShapeKind shape;
  double size[3];       /* [m], see TandemShapeKind */
  const double* points; /* hull: x, y, z of each point, in the body [m] */
  size_t point_count;
  double mass;       /* [kg]; 0: static */
  double inertia[3]; /* principal moments [kg m^2]; all 0: as Bullet takes them for the shape, of a
                        box around capsules and hulls */
  double friction;
  double restitution;
  TandemState start;
} TandemBodySettings;

/* Default: a box of 4 cm and 0.2 kg at the origin, friction 0.5. [any] */
TandemBodySettings tandem_default_body_settings(void);

/* Adds a body to a world of Tandem's. [setup] */
TandemResult tandem_world_add_body(TandemWorld* world, const TandemBodySettings* settings,
                                   TandemBody* body);

/* One of several shapes of a body. Shape, size and points are as in TandemBodySettings; no plane.
 */
typedef struct TandemShapePart {
  TandemShapeKind shape;
  double size[3];
  const double* points;
  size_t point_count;
  double position[3];    /* of the shape's origin in the body [m] */
  double orientation[4]; /* of the shape in the body: x, y, z, w, of length 1 */
} TandemShapePart;

/* Adds a body of `part_count` shapes to a world of Tandem's. They may overlap; each pushes by
   itself. The body's origin is its centre of mass. The shape in `settings` does not count; with no
   inertia it gets that of a box around all parts. [setup] */
TandemResult tandem_world_add_compound(TandemWorld* world, const TandemBodySettings* settings,
                                       size_t part_count, const TandemShapePart* parts,
                                       TandemBody* body);

/* Finds a body of the host's world by its btRigidBody. The host keeps it. [setup] */
TandemResult tandem_world_find_body(TandemWorld* world, void* rigid_body, TandemBody* body);

/* Removes a body from a world of Tandem's; fails while it is shared. [setup] */
TandemResult tandem_world_remove_body(TandemWorld* world, TandemBody body);

/* Reads the states of `count` bodies. [host] */
TandemResult tandem_world_get_states(const TandemWorld* world, size_t count,
                                     const TandemBody* bodies, TandemState* states);

/* Sets the state of a body. A shared body takes it as a change by the host. A static body takes
   the pose only; a guest is moved by its own engine. [host] */
TandemResult tandem_world_set_state(TandemWorld* world, TandemBody body, const TandemState* state);

/* Mass and surface of a body. */
typedef struct TandemDynamics {
  double mass;       /* [kg], of the whole object; 0 for a static body only */
  double inertia[3]; /* principal moments [kg m^2]; all 0: those of the shape */
  double friction;
  double restitution;
  double rolling_friction;  /* greatest torque against rolling per force [m] */
  double spinning_friction; /* the same about the normal of the contact */
} TandemDynamics;

/* Changes a body of a world of Tandem's at any time between two steps. A shared body carries its
   share of the new mass from the next step on. A moving body stays one. [host] */
TandemResult tandem_world_set_dynamics(TandemWorld* world, TandemBody body,
                                       const TandemDynamics* dynamics);

/* Applies a force [N] at the centre of mass and a torque [N m] in the next step; null: none.
   [host] */
TandemResult tandem_world_apply_force(TandemWorld* world, TandemBody body, const double force[3],
                                      const double torque[3]);

/* A point at which two bodies touch, in W. */
typedef struct TandemContact {
  TandemBody a; /* TANDEM_NO_BODY: a body without a number */
  TandemBody b;
  double point_a[3]; /* on the surface of each [m] */
  double point_b[3];
  double normal[3];   /* on b, towards a */
  double distance;    /* along the normal [m]; negative: they overlap */
  double force;       /* on a along the normal, in the latest step [N] */
  double friction[3]; /* force on a across the normal [N] */
} TandemContact;

/* Reads the contacts of the world as of its latest step, with those that the island solves. Writes
   at most `room`; `count` receives how many there are. [host] */
TandemResult tandem_world_get_contacts(const TandemWorld* world, size_t room,
                                       TandemContact* contacts, size_t* count);

/* Steps a world of Tandem's like Bullet's stepSimulation(): up to `max_substeps` of `fixed_step`
   [s]. With max_substeps 0 it makes one step of dt. [host] */
TandemResult tandem_world_step(TandemWorld* world, double dt, int max_substeps, double fixed_step);

/* One step of a host with its own engine, whose bodies stand in a world of Tandem's as guests:

     tandem_world_begin_step(world, dt, gravity, n, bodies, as_they_are, to_be_given);
     ... the host gives its bodies the velocities of to_be_given, and steps its engine by dt
     tandem_world_end_step(world, n, bodies, as_they_are_now, to_be_set);
     ... the host sets its bodies to to_be_set

   begin: `now` is the host's current state. A difference from the state that the host was last told
   is a change by the host: a pose is a move, a velocity an impulse. Then all ticks of the step run.
   `handoff` receives the host's poses, and the velocities that carry each body in dt to its place
   in the island. `host_gravity` [m/s^2] is subtracted beforehand, because the host's engine adds it
   to velocities; null: none.

   end: the engine may have changed these velocities further, by contacts with bodies of its own.
   That change goes to the island as an impulse and a move. `after` receives the state to set: the
   island's state with both.

   The engine must move bodies by the velocity after its forces, x += v dt, as most do
   (semi-implicit Euler). It must not add damping or gyroscopic terms. An impulse is a change of
   velocity times the body's mass here, which is m/N for a shared one: give the host's body that
   mass. Differences below 1e-9 [m, rad, m/s, rad/s] or below the rounding of a float, 2.4e-7 of a
   value, are ignored.

   Leave bodies that the host does not have out of `bodies`; move static ones by
   tandem_world_set_state(). Both calls name the same bodies. With sub-steps of the host, call both
   for each sub-step. `handoff`, `after` and `now` may be one array. [host] */
TandemResult tandem_world_begin_step(TandemWorld* world, double dt, const double host_gravity[3],
                                     size_t count, const TandemBody* bodies, const TandemState* now,
                                     TandemState* handoff);
TandemResult tandem_world_end_step(TandemWorld* world, size_t count, const TandemBody* bodies,
                                   const TandemState* now, TandemState* after);

/* --- Devices ----------------------------------------------------- */

typedef struct TandemDevice TandemDevice;

/* Limits of a device. */
typedef struct TandemDeviceLimits {
  double max_force; /* [N]; INFINITY: any */
  double max_slew;  /* fastest rise of the force that the hand should feel [N/s]; INFINITY: any */
} TandemDeviceLimits;

/* Creates a device that the caller moves: tandem_device_move() and tandem_device_get_force().
   Between two moves it continues with its velocity, for at most 50 ms. [setup] */
TandemResult tandem_device_create_moved(const double start[3], TandemDeviceLimits limits,
                                        TandemDevice** device);

/* [host] */
TandemResult tandem_device_move(TandemDevice* device, const double position[3],
                                const double velocity[3]);

/* Turns the wrist of a device that the caller moves: x, y, z, w of the hand in W, and its angular
   velocity [rad/s]. Before the first call the device has no wrist. [host] */
TandemResult tandem_device_turn(TandemDevice* device, const double orientation[4],
                                const double angular_velocity[3]);

/* Creates a simulated handle of `mass` [kg] with `damping` [N s/m] and a hand that pushes it.
   The hand's force is 0 until tandem_device_set_hand(). `guide` is the unit vector of a slot, or
   null. [setup] */
TandemResult tandem_device_create_simulated(double mass, double damping, const double start[3],
                                            const double* guide, TandemDevice** device);

/* Sets the simulated hand's force from now on [N]. [host] */
TandemResult tandem_device_set_hand(TandemDevice* device, const double force[3]);

/* Functions of the caller that read and write a device. They are called in [tick] once per
   haptic period, and once in tandem_site_create(). They must not block, allocate or call Tandem.
   An exception that leaves them ends the program. */
typedef struct TandemDeviceFunctions {
  /* Writes position [m] and velocity [m/s] of the haptic interface point in W at `now` [s].
     Returns 0 if there is no position: the force fades to zero. */
  int (*read)(void* user, double now, double position[3], double velocity[3]);
  void (*write)(void* user, const double force[3]); /* force on the hand, in W [N] */
  void* user;
} TandemDeviceFunctions;

/* [setup] */
TandemResult tandem_device_create(TandemDeviceFunctions functions, TandemDeviceLimits limits,
                                  TandemDevice** device);

/* Functions of the caller for a device that turns. They are called as the others are, with the same
   `user`. */
typedef struct TandemWristFunctions {
  /* Writes x, y, z, w of the hand in W and its angular velocity [rad/s] at `now` [s]. Returns 0 if
     they are not known: the wrist stands. */
  int (*read)(void* user, double now, double orientation[4], double angular_velocity[3]);
  void (*write)(void* user, const double torque[3]); /* on the hand, in W [N m]; null: none */
  double max_torque;                                 /* [N m]; 0 without `write` */
} TandemWristFunctions;

/* As tandem_device_create(), with a wrist. [setup] */
TandemResult tandem_device_create_turning(TandemDeviceFunctions functions,
                                          TandemWristFunctions wrist, TandemDeviceLimits limits,
                                          TandemDevice** device);

/* Reads the force on the hand that was rendered last, in W [N]. [host] */
TandemResult tandem_device_get_force(const TandemDevice* device, double force[3]);

/* [setup] */
TandemResult tandem_device_destroy(TandemDevice* device);

/* --- Links ------------------------------------------------------- */

typedef struct TandemLink TandemLink;

typedef struct TandemNetwork {
  double delay;     /* one way [s] */
  double jitter;    /* delays are uniform in delay +- jitter [s] */
  double loss;      /* probability, 0 to 1 */
  double duplicate; /* probability */
  double reorder;   /* probability that a packet jumps the queue */
  uint64_t seed;
} TandemNetwork;

/* Creates both ends of a simulated link between two sites of this process. One thread must tick
   both sites. [setup] */
TandemResult tandem_link_create_simulated(const TandemNetwork* network, TandemLink** first,
                                          TandemLink** second);

/* A state as sent to the other sites. It holds no forces. */
#define TANDEM_MAX_OBJECTS_PER_PACKET 8
#define TANDEM_NO_OBJECT UINT32_MAX
typedef struct TandemPacket {
  uint32_t sender;
  int is_idle;        /* packets come at 16 Hz: nothing moves there, or near here */
  uint64_t sequence;  /* from 0 */
  double time;        /* sender's time [s] */
  double position[3]; /* of the sender's haptic interface point */
  double velocity[3];
  double energy_granted;  /* to the receiver so far [J]; NAN: the sender keeps no account */
  double energy_holdings; /* for the sender's hand, without the receiver's grants [J] */
  size_t object_count;
  uint32_t object_ids[TANDEM_MAX_OBJECTS_PER_PACKET];
  TandemState objects[TANDEM_MAX_OBJECTS_PER_PACKET];
  /* Epoch of each object, and the site that began it: both are 0 until a site puts it elsewhere. */
  uint32_t object_epochs[TANDEM_MAX_OBJECTS_PER_PACKET];
  uint32_t object_epoch_authors[TANDEM_MAX_OBJECTS_PER_PACKET];
  /* What the sender's user holds: tandem_site_grab(). */
  int has_grip;               /* 0: nothing yet, and the rest means nothing */
  uint32_t grip_epoch;        /* counts grabs and releases, modulo 65536 */
  uint32_t grip_object;       /* TANDEM_NO_OBJECT: nothing now */
  double grip_position[3];    /* on the object, from its centre of mass, in its frame [m] */
  double grip_orientation[4]; /* x, y, z, w of the world in the object's frame, as wanted */
  double grip_age;            /* from the last grab or release to `time` [s] */
  /* Sites, bit i for id i + 1, that the sender hears, and among which it shares its objects. Both
     are 0 unless TandemSiteSettings.membership_follows is 1. */
  uint64_t roll_heard;
  uint64_t roll_members;
  double roll_age; /* of the sender's site [s] */
} TandemPacket;

/* Creates a link whose packets the caller carries. It holds up to 256 packets each way; more are
   lost, as on any network. [setup] */
TandemResult tandem_link_create_manual(TandemLink** link);

/* Delivers an incoming packet for the next tick. It is checked like any from a network; the site
   drops and counts an invalid one. Real-time safe. [carry] */
TandemResult tandem_link_push(TandemLink* link, const TandemPacket* packet);

/* Takes a packet to be sent. If there is none, sets `there` to 0 and writes nothing else.
   Real-time safe. [carry] */
TandemResult tandem_link_pop(TandemLink* link, TandemPacket* packet, int* there);

/* Fails for a link that belongs to a mesh. [setup] */
TandemResult tandem_link_destroy(TandemLink* link);

/* --- UDP --------------------------------------------------------- */

typedef struct TandemMesh TandemMesh;

typedef struct TandemMeshPeer {
  uint32_t id;
  const char* address;  /* "host:port"; null: the peer calls us */
  const char* key_file; /* key shared by this pair: tandem_key_create() */
} TandemMeshPeer;

/* An item that must be equal at all sites before they are coupled, such as "object.mass" "0.2". */
typedef struct TandemAgreement {
  const char* key;
  const char* value;
} TandemAgreement;

/* Creates a key for both sites of a pair, in a file that only its owner may read. [any] */
TandemResult tandem_key_create(const char* path);

/* Creates sealed links to all peers over one socket bound to `bind` ("0.0.0.0:7001"). [setup] */
TandemResult tandem_mesh_create(uint32_t self, const char* bind, size_t peer_count,
                                const TandemMeshPeer* peers, size_t agreement_count,
                                const TandemAgreement* agreements, TandemMesh** mesh);

/* Port of the socket, useful if `bind` had port 0 (any). [any] */
TandemResult tandem_mesh_port(const TandemMesh* mesh, uint16_t* port);

/* Link to a peer; it belongs to the mesh. [setup] */
TandemResult tandem_mesh_link(TandemMesh* mesh, uint32_t peer, TandemLink** link);

/* Takes received datagrams and sends due ones. Call it before each tick or host step; with a
   loop 1000 times a second, from a thread of its own if needed. Rarer calls delay the states.
   `now` is any clock of the caller that does not run back [s]; it may differ from the sites'
   times. Never blocks. [carry] */
TandemResult tandem_mesh_poll(TandemMesh* mesh, double now);

typedef enum TandemPeerPhase {
  TANDEM_PEER_CALLING = 0,   /* no answer yet, or none for 5 s */
  TANDEM_PEER_AGREEING = 1,  /* agreements are being compared */
  TANDEM_PEER_DIFFERENT = 2, /* the agreements differ: nothing is coupled */
  TANDEM_PEER_LIVE = 3,
  TANDEM_PEER_LEFT = 4 /* the peer said farewell */
} TandemPeerPhase;

typedef struct TandemPeerStatus {
  TandemPeerPhase phase;
  double silence;    /* [s] */
  double round_trip; /* [s] */
  double loss;       /* lost fraction of the peer's states, 0 to 1 */
} TandemPeerStatus;

/* [carry] */
TandemResult tandem_mesh_status(const TandemMesh* mesh, uint32_t peer, double now,
                                TandemPeerStatus* status);

/* Explains why a peer does not become live: the agreement that differs, or the reason of its
   refusal. One line each, or nothing. Parameters as in tandem_site_warnings(). [carry] */
TandemResult tandem_mesh_explain(const TandemMesh* mesh, uint32_t peer, char* text, size_t room,
                                 size_t* length);

/* Says farewell to all peers; poll for another 0.1 s, then destroy. [carry] */
TandemResult tandem_mesh_leave(TandemMesh* mesh, double now);

/* [setup] */
TandemResult tandem_mesh_destroy(TandemMesh* mesh);

/* --- Sites ------------------------------------------------------- */

typedef struct TandemSite TandemSite;

typedef enum TandemTickSource {
  TANDEM_TICK_HOST_STEP = 0, /* the site ticks itself inside the world's steps */
  TANDEM_TICK_CALLER = 1     /* tandem_site_tick(), or a loop: tandem_site_start_loop() */
} TandemTickSource;

/* How the copies of an object, and the stand-ins of remote users, share K_t and B_t. */
typedef enum TandemCoordinationMode {
  TANDEM_COORDINATION_SUM = 0,    /* each pair of copies is tied: stiffness and drag grow with N */
  TANDEM_COORDINATION_AVERAGE = 1 /* each copy is tied to the mean of all N copies */
} TandemCoordinationMode;

typedef struct TandemSiteSettings {
  int internal;             /* set by tandem_default_site_settings() */
  uint32_t self;            /* id of this site, 1 or more */
  int peers;                /* N: each of N copies of a shared object carries m/N */
  double haptic_rate;       /* [Hz] */
  double packet_rate;       /* states sent per second [Hz] */
  double packet_budget;     /* sent to all peers together [bit/s]; far ones get less; 0: no limit */
  int thins_when_idle;      /* fewer packets while nothing moves */
  double host_step;         /* first step expected of the host [s]; 0: learnt from it */
  TandemGains contact;      /* K_vc, B_vc */
  TandemGains coordination; /* K_t, B_t */
  TandemCoordinationMode coordination_mode;
  double proxy_mass;    /* m_h [kg] */
  double proxy_damping; /* b_h [N s/m] */
  double proxy_radius;  /* [m] */
  double hip_radius;    /* radius of the local haptic interface point [m] */
  int hand_group;       /* collision group of the hand and of proxies */
  int hand_mask;        /* collision groups that the hand and proxies meet */
  /* The hand feels moving bodies with nothing shared, too; 0: the host's bits stay the same. */
  int hand_feels_moving_bodies;
  int puts_reset_objects; /* 0: an object that a peer's host put elsewhere is led there */
  const char* scheme;     /* "remote_dynamic_proxy", "kinematic_proxy" or "virtual_coupling" */
  TandemTickSource tick_source;
  int has_guide;      /* bodies may only move along `guide` */
  double guide[3];    /* unit vector */
  double inner_step;  /* integration step of non-linear motion [s] */
  int max_neighbours; /* most host bodies that the island holds at a time */
  int link_loss;      /* gains fade when a remote falls silent; 0: its last state pulls for ever */
  int membership_follows;        /* N follows who is there; `peers` counts for nothing then */
  double membership_leave_after; /* silence after which a peer no longer counts [s] */
  int passivity;                 /* keeps an energy account */
  double max_slew;               /* limit of the device force's rise [N/s] */
  double fault_slew;             /* rate at which the force fades after a fault [N/s] */
  /* The hand's grip: tandem_site_grab(). */
  double grip_stiffness;     /* K [N/m] */
  double grip_damping_ratio; /* of the spring with hand and object */
  double grip_radius;        /* r [m]: the torque's spring has K r^2 */
  double grip_max_force;     /* [N]; times r: of the torque [N m] */
  double grip_lift_time;     /* within which the hand takes over a weight [s]; 0: objects sag */
  double grip_blend_time;    /* within which an object comes to the hand [s] */
  double grip_break_time;    /* at the force's limit, after which the grip breaks [s] */
  double grip_fade_time;     /* of the force after a release [s] */
  /* The hold of a tool: tandem_site_share_tool(). */
  double tool_stiffness;     /* K [N/m] */
  double tool_damping_ratio; /* of the spring with hand and tool */
  double tool_radius;        /* r [m]: the torque's spring has K r^2 */
  double tool_max_force;     /* [N]; times r: of the torque [N m] */
} TandemSiteSettings;

/* Gains, masses and rates of the paper's Experiment I. [any] */
TandemSiteSettings tandem_default_site_settings(void);

/* Creates a site. A world takes one site. [setup] */
TandemResult tandem_site_create(const TandemSiteSettings* settings, TandemWorld* world,
                                TandemDevice* device, TandemSite** site);

/* Restores the host's bodies and ends a loop. The handles of proxies become invalid. [setup] */
TandemResult tandem_site_destroy(TandemSite* site);

/* Shares a dynamic box, sphere, capsule, cylinder, cone or hull. Its mass and inertia become m/N of
   their value until the site ends. All sites share the same objects in the same order: `object`
   counts from 0. `damping` acts on this copy [N s/m]. [setup] */
TandemResult tandem_site_share(TandemSite* site, TandemBody body, double damping, uint32_t* object);

/* Gives a user a tool: a dynamic body of any shape that tandem_site_share() takes. At the user's
   own site (`self`) the hand holds it from the first tick on, by its place `at` from the centre of
   mass in the tool's frame [m]; null: there. At the others the user's proxy holds theirs. The tool
   touches things, rigidly and with its friction; hand and proxy touch nothing meanwhile. It turns
   with a wrist, keeps its whole mass, and its copies are not tied. tandem_site_release() lays it
   down, tandem_site_grab() takes it up. All sites share tools and objects in the same order. Fails
   while the hand holds something, and with a guide. [setup] */
TandemResult tandem_site_share_tool(TandemSite* site, TandemBody body, uint32_t user,
                                    const double at[3], uint32_t* object);

/* Gives a shared object back, with its own mass and the velocity that it has. Its number stays for
   tandem_site_share_again(), and the others stay shared. Peers let go of their copies after 16
   packets without it. Between two steps, also with a loop; the body may be removed at once. Does
   nothing if it is not shared. Fails with a guide. [host] */
TandemResult tandem_site_unshare(TandemSite* site, uint32_t object);

/* Shares a body for an object that was unshared, or whose body the host removed from its world:
   the same body or another. It keeps the object's damping, and is held from the next step on.
   [host] */
TandemResult tandem_site_share_again(TandemSite* site, uint32_t object, TandemBody body);

/* Tells that the host has moved all of its Bullet world by `offset` since its last step, to keep
   its numbers small. Touch and couplers go on, the device's positions go along, and peers notice
   nothing. Fails for a world of Tandem's. [host] */
TandemResult tandem_site_shift_origin(TandemSite* site, const double offset[3]);

/* Who moves a shared object. */
typedef enum TandemObjectState {
  TANDEM_OBJECT_HELD = 0,    /* the island */
  TANDEM_OBJECT_LEFT = 1,    /* Bullet, meanwhile: the island cannot hold its body. A static or
                                kinematic one, without contact response or with
                                DISABLE_SIMULATION; peers follow it */
  TANDEM_OBJECT_MISSING = 2, /* the host removed its body from the world */
  TANDEM_OBJECT_UNSHARED = 3 /* no body since tandem_site_unshare() */
} TandemObjectState;

/* State of an object as of the latest step. tandem_site_warnings() names objects that are left or
   missing, with the remedy. [host] */
TandemResult tandem_site_object_state(const TandemSite* site, uint32_t object,
                                      TandemObjectState* state);

/* Lets the hand hold a shared object by its place `at`, from the centre of mass in the object's
   frame [m]; null: where the hand is. A spring and damper keep the place at the hand, and the
   object as it is turned now. Its weight passes to the hand. At the peers the user's proxy takes
   the same hold of their copy. A grip that is pulled at its limit for grip_break_time breaks; it
   ends as well when the object is unshared, left or put elsewhere. Fails for an object that is not
   held by the island, while the hand holds another one, and with a guide. Between two steps, also
   with a loop. [host] */
TandemResult tandem_site_grab(TandemSite* site, uint32_t object, const double at[3]);

/* Lets go: the force fades within grip_fade_time. Does nothing without a grip. [host] */
TandemResult tandem_site_release(TandemSite* site);

/* What the hand holds. */
typedef struct TandemGrip {
  uint32_t object;  /* TANDEM_NO_OBJECT: nothing, and the rest is 0 */
  int is_fading;    /* the hand has let go */
  double at[3];     /* place on the object, from the centre of mass, in its frame [m] */
  double force[3];  /* on the object, in W; the hand gets the opposite, before its limits [N] */
  double torque[3]; /* on the object, besides that of the force [N m] */
} TandemGrip;

/* Reads the grip as of the latest tick. [host]; with a loop it waits for the end of a tick. */
TandemResult tandem_site_read_grip(TandemSite* site, TandemGrip* grip);

/* Connects a remote user whose hand starts at `start`. `proxy` receives the body that stands for
   the user, which a host with another engine mirrors; TANDEM_NO_BODY if the scheme has none. It
   may be null. [setup] */
TandemResult tandem_site_connect(TandemSite* site, uint32_t peer, TandemLink* link,
                                 const double start[3], TandemBody* proxy);

/* Report of a tick. */
typedef enum TandemStatus {
  TANDEM_STATUS_DEVICE_INVALID = 1 << 0,   /* no usable device reading: no force */
  TANDEM_STATUS_BODY_MISSING = 1 << 1,     /* a body is not in the world: see warnings */
  TANDEM_STATUS_PACKET_REFUSED = 1 << 2,   /* a packet was invalid: check the sender */
  TANDEM_STATUS_HOST_STEP_WRONG = 1 << 3,  /* impulse injection needs steps of a haptic period */
  TANDEM_STATUS_STATE_NOT_FINITE = 1 << 4, /* lower gains or inner_step; no force from now on */
  TANDEM_STATUS_WORLD_GONE = 1 << 5,       /* the world was destroyed: destroy the site */
  TANDEM_STATUS_OUT_OF_RANGE = 1 << 6      /* a body is too far or fast for packets: not sent */
} TandemStatus;

/* Advances one haptic period from `now` [s]; the first call starts the clock. Only with
   TANDEM_TICK_CALLER and without a loop. `status` receives the bits of this tick; may be null.
   Real-time safe. [tick] */
TandemResult tandem_site_tick(TandemSite* site, double now, uint32_t* status);

/* Starts a thread that ticks the site in real time; needs TANDEM_TICK_CALLER. The host then
   steps its world in real time, too. `priority` is of SCHED_FIFO, 0: none. Until the loop stops,
   tandem_site_tick() and set-up calls of this site fail. Simulated links cannot be used: they
   belong to one thread. [setup] */
TandemResult tandem_site_start_loop(TandemSite* site, int priority);

/* Fades the force to zero and ends the thread; does nothing without a loop. [setup] */
TandemResult tandem_site_stop_loop(TandemSite* site);

/* State of the link to a remote. */
typedef enum TandemLinkState {
  TANDEM_LINK_WAITING = 0,
  TANDEM_LINK_LIVE = 1,
  TANDEM_LINK_STALE = 2,
  TANDEM_LINK_FADING = 3,
  TANDEM_LINK_LOST = 4,
  TANDEM_LINK_REJOINING = 5
} TandemLinkState;

/* State of a site at one moment. */
typedef struct TandemReading {
  double force[3];        /* on the hand, in W [N] */
  double hip[3];          /* haptic interface point [m] */
  double hip_velocity[3]; /* [m/s] */
  uint64_t ticks;
  uint32_t status;     /* TandemStatus bits since the start */
  uint64_t state_hash; /* equal runs have equal hashes */
  uint64_t packets_sent;
  uint64_t packets_taken;
  size_t object_count;
  size_t remote_count;
  double torque[3]; /* on the hand, in W [N m] */
} TandemReading;

/* Reads objects and proxies in the island. `objects` has room for `object_room` states, in the
   order of sharing. `proxies` and `links` have room for `remote_room`, in the order of
   connecting. The rest is left out; null reads none. A missing proxy has a state of NAN. [host];
   with a loop it waits for the end of a tick. */
TandemResult tandem_site_read(TandemSite* site, TandemReading* reading, size_t object_room,
                              TandemState* objects, size_t remote_room, TandemState* proxies,
                              TandemLinkState* links);

/* Facts that a user should know about the attached world, and rights that the system did not
   grant a loop, one line each. Writes at most `room` bytes with the final 0. `length` (or null)
   receives the whole length without it. [setup] */
TandemResult tandem_site_warnings(const TandemSite* site, char* text, size_t room, size_t* length);

#if defined(__GNUC__)
#pragma GCC visibility pop
#endif

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* TANDEM_TANDEM_H */
