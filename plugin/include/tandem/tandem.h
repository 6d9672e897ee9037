#ifndef TANDEM_TANDEM_H
#define TANDEM_TANDEM_H

/* Tandem's C door: everything that a binding of another language needs. C99, and C++.

   A *world* is a Bullet world: the host's own, or one of Tandem's. A *device* is a hand, a *link*
   the way to one remote user, and a *site* ties them together: share bodies, connect remotes, step.
   A host whose engine is not Bullet, or that does not show its Bullet world, makes a world of
   Tandem's, adds the bodies that users share as *guests*, and asks before and after each of its
   steps what to do with them: tandem_world_begin_step().

   Conventions. SI units. Right-handed world frame W. Quaternions are x, y, z, w. Arrays belong to
   the caller, and are read or written during the call only. Strings are UTF-8 and end with 0.
   Handles are made and destroyed by functions of their name; to destroy a null handle does nothing.

   Errors. Functions that can fail return TandemResult; on failure they change nothing, write
   nothing but say why in one line: tandem_last_error(). No exception crosses. A handle that another
   one still uses is not destroyed (TANDEM_IN_USE): sites go first, then worlds, devices, links,
   meshes. A null handle, one of another kind and one that was destroyed lately are refused.

   Threads, said at each function:

   - [any]: from any thread at any time.

   - [setup]: one thread at a time for all handles that are tied together by a site; not while a
   loop runs, but tandem_site_stop_loop() and tandem_site_warnings(), which are for then.

   - [host]: the thread that steps the world, which may be another one than that of [setup] but not
   at the same time. With a loop, too.

   - [tick]: the thread that ticks the site: [host], unless tick_source is TANDEM_TICK_CALLER.

   - [carry]: the thread that carries packets: [tick], or with a loop any one other, from its start
   to its end.

   Sites of different worlds are independent, each may have its own threads. */

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
  TANDEM_INVALID_ARGUMENT = 1, /* a value out of range, or a null where there must be none */
  TANDEM_CANNOT = 2, /* set-up that cannot work: a body of a shape that cannot be shared, ... */
  TANDEM_WRONG_BULLET = 3, /* scalar width or version of the host's Bullet is not this library's */
  TANDEM_IN_USE = 4,       /* another handle still needs this one */
  TANDEM_WORLD_GONE = 5,   /* the host has destroyed its world; destroy the site */
  TANDEM_NO_MEMORY = 6,
  TANDEM_INTERNAL = 7 /* a bug of Tandem */
} TandemResult;

/* "TANDEM_IN_USE". [any] */
const char* tandem_result_name(TandemResult result);

/* Why the latest call of this thread that failed did so: one line with the value and the remedy; ""
   before that. Until the next call that fails in this thread. [any] */
const char* tandem_last_error(void);

/* "0.1.0", of the library that was loaded. [any] */
const char* tandem_version(void);

/* Size of btScalar of the Bullet that the library was built for [bytes]: 4 or 8. [any] */
size_t tandem_scalar_bytes(void);

/* --- Values ------------------------------------------------------ */

/* Pose of the centre of mass in W, and its velocities in W. */
typedef struct TandemState {
  double position[3];         /* [m] */
  double orientation[4];      /* x, y, z, w; of unit length */
  double velocity[3];         /* [m/s] */
  double angular_velocity[3]; /* [rad/s] */
} TandemState;

typedef struct TandemGains {
  double stiffness; /* [N/m], or [N m/rad] */
  double damping;   /* [N s/m], or [N m s/rad] */
} TandemGains;

/* --- Worlds ------------------------------------------------------ */

typedef struct TandemWorld TandemWorld;

/* A body of a world. Of a world of Tandem's never given twice; in a host's world it goes by the
   body's address. */
typedef uint32_t TandemBody;
#define TANDEM_NO_BODY 0u

/* A world of Tandem's own, empty and without gravity. [setup] */
TandemResult tandem_world_create(TandemWorld** world);

/* The host's btDiscreteDynamicsWorld (a class derived from it: its address as that). `scalar_bytes`
   and `bullet_version` are the host's sizeof(btScalar) and BT_BULLET_VERSION, so that a mismatch is
   refused instead of giving nonsense; in C++: TANDEM_ATTACH_ABI. The world should outlive the
   handle. [setup] */
TandemResult tandem_world_attach(void* discrete_dynamics_world, size_t scalar_bytes,
                                 int bullet_version, TandemWorld** world);
#define TANDEM_ATTACH_ABI sizeof(btScalar), BT_BULLET_VERSION

/* Refused while a site is on it. [setup] */
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
  TANDEM_PLANE = 5     /* all below z = 0 of the body; only with mass 0 */
} TandemShapeKind;

typedef struct TandemBodySettings {
  int internal; /* set by tandem_default_body_settings() */
  TandemShapeKind shape;
  double size[3];       /* [m], see TandemShapeKind */
  const double* points; /* of a hull: x, y, z of each, in the body [m] */
  size_t point_count;
  double mass;       /* [kg]; 0: static */
  double inertia[3]; /* principal moments [kg m^2]; all 0: as Bullet takes them for the shape, of a
                        box around capsules and hulls */
  double friction;
  double restitution;
  TandemState start;
} TandemBodySettings;

/* A box of 4 cm and 0.2 kg at the origin, friction 0.5. [any] */
TandemBodySettings tandem_default_body_settings(void);

/* Adds a body to a world of Tandem's. [setup] */
TandemResult tandem_world_add_body(TandemWorld* world, const TandemBodySettings* settings,
                                   TandemBody* body);

/* A body of the host's world by its btRigidBody. The host keeps it. [setup] */
TandemResult tandem_world_find_body(TandemWorld* world, void* rigid_body, TandemBody* body);

/* Takes a body out of a world of Tandem's; refused while it is shared. [setup] */
TandemResult tandem_world_remove_body(TandemWorld* world, TandemBody body);

/* States of `count` bodies. [host] */
TandemResult tandem_world_get_states(const TandemWorld* world, size_t count,
                                     const TandemBody* bodies, TandemState* states);

/* Sets the state of a body; a shared one feels it as a change by the host. A static one takes the
   pose only; a guest is moved by its own engine. [host] */
TandemResult tandem_world_set_state(TandemWorld* world, TandemBody body, const TandemState* state);

/* A force for the next step [N], at the centre of mass, and a torque [N m]; null: none. [host] */
TandemResult tandem_world_apply_force(TandemWorld* world, TandemBody body, const double force[3],
                                      const double torque[3]);

/* Steps a world of Tandem's, as Bullet's stepSimulation(): up to `max_substeps` of `fixed_step`
   [s], or, with max_substeps 0, one of dt. [host] */
TandemResult tandem_world_step(TandemWorld* world, double dt, int max_substeps, double fixed_step);

/* One step of a host with an engine of its own, whose bodies stand in a world of Tandem's as
   guests:

     tandem_world_begin_step(world, dt, gravity, n, bodies, as_they_are, to_be_given);
     ... the host gives its bodies the velocities of to_be_given, and steps its engine by dt
     tandem_world_end_step(world, n, bodies, as_they_are_now, to_be_set);
     ... the host sets its bodies to to_be_set

   begin: `now` is what the host has. What differs from what it was told last the host has done: a
   pose is a move, a velocity an impulse. Then all ticks of the step run. `handoff` has the host's
   poses, and the velocities that carry each body to where the island has it in dt. `host_gravity`
   is what the host's engine will add to velocities by itself [m/s^2], and is taken off beforehand;
   null: nothing. end: what the host's engine made of these velocities besides (contact with bodies
   of its own) goes to the island as an impulse, and `after` is what to set: the island's state,
   with that.

   The engine must move bodies by the velocity that they have after its forces, x += v dt, as most
   do (semi-implicit Euler), without damping and gyroscopic terms of its own. An impulse is a change
   of velocity times the mass that the body has here, m/N of a shared one: give the host's body that
   mass. Differences below 1e-9 [m, rad, m/s, rad/s], or of a host's rounding to float, 2.4e-7 of a
   value, are none.

   Bodies that the host has not are left out of `bodies`; static ones are moved by
   tandem_world_set_state(). Both calls name the same bodies. Sub-steps of the host: once for each.
   `handoff`, `after` and `now` may be one array. [host] */
TandemResult tandem_world_begin_step(TandemWorld* world, double dt, const double host_gravity[3],
                                     size_t count, const TandemBody* bodies, const TandemState* now,
                                     TandemState* handoff);
TandemResult tandem_world_end_step(TandemWorld* world, size_t count, const TandemBody* bodies,
                                   const TandemState* now, TandemState* after);

/* --- Devices ----------------------------------------------------- */

typedef struct TandemDevice TandemDevice;

/* What a device can do. */
typedef struct TandemDeviceLimits {
  double max_force; /* [N]; INFINITY: any */
  double max_slew;  /* fastest change of the force that the hand should feel [N/s]; INFINITY: any */
} TandemDeviceLimits;

/* A device that the caller moves: tandem_device_move() and tandem_device_get_force(). Between two
   calls it goes on with its velocity, for 50 ms at the most. [setup] */
TandemResult tandem_device_create_moved(const double start[3], TandemDeviceLimits limits,
                                        TandemDevice** device);

/* [host] */
TandemResult tandem_device_move(TandemDevice* device, const double position[3],
                                const double velocity[3]);

/* A handle of `mass` [kg] with `damping` [N s/m] in a hand that pushes with a force: 0 until
   tandem_device_set_hand(). `guide` is the unit vector of a slot, or null. [setup] */
TandemResult tandem_device_create_simulated(double mass, double damping, const double start[3],
                                            const double* guide, TandemDevice** device);

/* The simulated hand's force from now on [N]. [host] */
TandemResult tandem_device_set_hand(TandemDevice* device, const double force[3]);

/* A device that is read and written by functions of the caller, called in [tick] once per haptic
   period, and in tandem_site_create() once. They must not block, allocate or call Tandem; an
   exception that leaves them ends the program. */
typedef struct TandemDeviceFunctions {
  /* Position [m] and velocity [m/s] of the haptic interface point in W at `now` [s]; 0 if there is
     none: the force fades to zero. */
  int (*read)(void* user, double now, double position[3], double velocity[3]);
  void (*write)(void* user, const double force[3]); /* on the hand, in W [N] */
  void* user;
} TandemDeviceFunctions;

/* [setup] */
TandemResult tandem_device_create(TandemDeviceFunctions functions, TandemDeviceLimits limits,
                                  TandemDevice** device);

/* The force on the hand that was rendered last, in W [N]. [host] */
TandemResult tandem_device_get_force(const TandemDevice* device, double force[3]);

/* [setup] */
TandemResult tandem_device_destroy(TandemDevice* device);

/* --- Links ------------------------------------------------------- */

typedef struct TandemLink TandemLink;

typedef struct TandemNetwork {
  double delay;     /* one way [s] */
  double jitter;    /* delay is even in delay +- jitter [s] */
  double loss;      /* probability, 0 to 1 */
  double duplicate; /* probability */
  double reorder;   /* probability that a packet jumps the queue */
  uint64_t seed;
} TandemNetwork;

/* Both ends of a simulated way between two sites of this process. Both sites must be ticked by one
 * thread. [setup] */
TandemResult tandem_link_create_simulated(const TandemNetwork* network, TandemLink** first,
                                          TandemLink** second);

/* A state as it goes to the other sites: never forces. */
#define TANDEM_MAX_OBJECTS_PER_PACKET 8
typedef struct TandemPacket {
  uint32_t sender;
  int is_idle;        /* nothing moves there: packets come at 16 Hz */
  uint64_t sequence;  /* from 0 */
  double time;        /* sender's [s] */
  double position[3]; /* of the sender's haptic interface point */
  double velocity[3];
  double port_energy; /* put in by the sender so far [J]; NAN: it keeps no account */
  size_t object_count;
  uint32_t object_ids[TANDEM_MAX_OBJECTS_PER_PACKET];
  TandemState objects[TANDEM_MAX_OBJECTS_PER_PACKET];
} TandemPacket;

/* A way of the caller's: packets that the site sends are taken, and those that have come in are
   given, by hand. Holds up to 256 each way; what finds no room is lost, as on any way. [setup] */
TandemResult tandem_link_create_manual(TandemLink** link);

/* Gives a packet that has come in, for the next tick. It is checked as any from a network: one that
   is not sane is dropped and counted by the site. Real-time safe. [carry] */
TandemResult tandem_link_push(TandemLink* link, const TandemPacket* packet);

/* Takes a packet to be sent; `there` is 0 if there is none, and nothing is written then. Real-time
   safe. [carry] */
TandemResult tandem_link_pop(TandemLink* link, TandemPacket* packet, int* there);

/* Not of a link that belongs to a mesh. [setup] */
TandemResult tandem_link_destroy(TandemLink* link);

/* --- UDP --------------------------------------------------------- */

typedef struct TandemMesh TandemMesh;

typedef struct TandemMeshPeer {
  uint32_t id;
  const char* address;  /* "host:port"; null: it is to call us */
  const char* key_file; /* of the key that this pair shares: tandem_key_create() */
} TandemMeshPeer;

/* Items that must be the same at all sites before anything is coupled, such as "object.mass" "0.2".
 */
typedef struct TandemAgreement {
  const char* key;
  const char* value;
} TandemAgreement;

/* A new key of a pair, for both its sites, in a file that only its owner may read. [any] */
TandemResult tandem_key_create(const char* path);

/* Sealed ways to all peers over one socket bound to `bind` ("0.0.0.0:7001"). [setup] */
TandemResult tandem_mesh_create(uint32_t self, const char* bind, size_t peer_count,
                                const TandemMeshPeer* peers, size_t agreement_count,
                                const TandemAgreement* agreements, TandemMesh** mesh);

/* The port that its socket has, for one that was bound to port 0: any. [any] */
TandemResult tandem_mesh_port(const TandemMesh* mesh, uint16_t* port);

/* The way to a peer; belongs to the mesh. [setup] */
TandemResult tandem_mesh_link(TandemMesh* mesh, uint32_t peer, TandemLink** link);

/* Takes in what is there and sends what is due: before each tick or host step, and with a loop 1000
   times a second, from a thread of its own if need be; less often, states come as much later. `now`
   is any clock of the caller's that does not run back [s]; the sites' times may be others. Never
   blocks. [carry] */
TandemResult tandem_mesh_poll(TandemMesh* mesh, double now);

typedef enum TandemPeerPhase {
  TANDEM_PEER_CALLING = 0,   /* no answer yet, or none for 5 s */
  TANDEM_PEER_AGREEING = 1,  /* agreements are being compared */
  TANDEM_PEER_DIFFERENT = 2, /* they differ: nothing is coupled */
  TANDEM_PEER_LIVE = 3,
  TANDEM_PEER_LEFT = 4 /* it has said farewell */
} TandemPeerPhase;

typedef struct TandemPeerStatus {
  TandemPeerPhase phase;
  double silence;    /* [s] */
  double round_trip; /* [s] */
  double loss;       /* of the peer's packets, 0 to 1 */
} TandemPeerStatus;

/* [carry] */
TandemResult tandem_mesh_status(const TandemMesh* mesh, uint32_t peer, double now,
                                TandemPeerStatus* status);

/* What a user should know of a peer that does not become live: the agreement that differs, why it
   refuses us; one line each, or nothing. As tandem_site_warnings(). [carry] */
TandemResult tandem_mesh_explain(const TandemMesh* mesh, uint32_t peer, char* text, size_t room,
                                 size_t* length);

/* Says farewell to all; poll for another 0.1 s, then destroy. [carry] */
TandemResult tandem_mesh_leave(TandemMesh* mesh, double now);

/* [setup] */
TandemResult tandem_mesh_destroy(TandemMesh* mesh);

/* --- Sites ------------------------------------------------------- */

typedef struct TandemSite TandemSite;

typedef enum TandemTickSource {
  TANDEM_TICK_HOST_STEP =
      0,                 /* the site ticks itself inside the world's steps: nothing else to do */
  TANDEM_TICK_CALLER = 1 /* tandem_site_tick(), or a loop: tandem_site_start_loop() */
} TandemTickSource;

typedef struct TandemSiteSettings {
  int internal;             /* set by tandem_default_site_settings() */
  uint32_t self;            /* id of this site, 1 or more */
  int peers;                /* N: each of N copies of a shared object carries m/N */
  double haptic_rate;       /* [Hz] */
  double packet_rate;       /* states sent per second [Hz] */
  int thins_when_idle;      /* fewer packets while nothing moves */
  double host_step;         /* expected first step of the host [s]; 0: learnt from it */
  TandemGains contact;      /* K_vc, B_vc */
  TandemGains coordination; /* K_t, B_t */
  double proxy_mass;        /* m_h [kg] */
  double proxy_damping;     /* b_h [N s/m] */
  double proxy_radius;      /* [m] */
  double hip_radius;        /* of the local haptic interface point [m] */
  const char* scheme;       /* "remote_dynamic_proxy", "kinematic_proxy" or "virtual_coupling" */
  TandemTickSource tick_source;
  int has_guide;      /* bodies move along `guide` only */
  double guide[3];    /* unit vector */
  double inner_step;  /* where motion is not linear [s] */
  int max_neighbours; /* bodies of the host that the island may hold at a time */
  int link_loss;      /* gains fade when a remote falls silent; 0: the last state pulls for ever */
  int passivity;      /* account of energy */
  double max_slew;    /* change of the force at the device [N/s] */
  double fault_slew;  /* after a fault the force fades by this [N/s] */
} TandemSiteSettings;

/* The gains, masses and rates of the paper's Experiment I. [any] */
TandemSiteSettings tandem_default_site_settings(void);

/* A world takes one site. [setup] */
TandemResult tandem_site_create(const TandemSiteSettings* settings, TandemWorld* world,
                                TandemDevice* device, TandemSite** site);

/* Gives the host everything back as it was, and ends a loop. Its proxies are bodies no more.
 * [setup] */
TandemResult tandem_site_destroy(TandemSite* site);

/* Shares a dynamic box, sphere, capsule, cylinder or hull: its mass and inertia become m/N of what
   they are until the site ends. All sites share the same objects in the same order: `object` counts
   from 0. `damping` acts on this copy [N s/m]. [setup] */
TandemResult tandem_site_share(TandemSite* site, TandemBody body, double damping, uint32_t* object);

/* Connects a remote user whose hand starts at `start`. `proxy` is the body that stands for the
   user, to be mirrored by a host with another engine; TANDEM_NO_BODY where the scheme has none.
   Null: not wanted. [setup] */
TandemResult tandem_site_connect(TandemSite* site, uint32_t peer, TandemLink* link,
                                 const double start[3], TandemBody* proxy);

/* What a tick has to report; see the bits. */
typedef enum TandemStatus {
  TANDEM_STATUS_DEVICE_INVALID = 1
                                 << 0, /* the device gave nothing usable: no force until it does */
  TANDEM_STATUS_BODY_MISSING = 1 << 1, /* a body was taken out of the world: make a new site */
  TANDEM_STATUS_PACKET_REFUSED = 1 << 2, /* a packet held nonsense: check the sender */
  TANDEM_STATUS_HOST_STEP_WRONG =
      1 << 3, /* impulse injection with another step than the haptic period */
  TANDEM_STATUS_STATE_NOT_FINITE = 1 << 4, /* lower gains or inner_step; the force stays at zero */
  TANDEM_STATUS_WORLD_GONE = 1 << 5        /* the world was destroyed: destroy the site */
} TandemStatus;

/* One haptic period from `now` [s]; the first call starts the clock. Only with TANDEM_TICK_CALLER
   and without a loop. `status` gets the bits of this tick; may be null. Real-time safe. [tick] */
TandemResult tandem_site_tick(TandemSite* site, double now, uint32_t* status);

/* A thread of its own ticks the site in real time, with TANDEM_TICK_CALLER; the host steps its
   world in real time, too. `priority` of SCHED_FIFO, 0: none. Until the loop is stopped,
   tandem_site_tick() and the set-up of this site are refused. Not with simulated links, which
   belong to one thread. [setup] */
TandemResult tandem_site_start_loop(TandemSite* site, int priority);

/* The force fades to zero and the thread ends; without a loop, nothing. [setup] */
TandemResult tandem_site_stop_loop(TandemSite* site);

/* How a remote is doing. */
typedef enum TandemLinkState {
  TANDEM_LINK_WAITING = 0,
  TANDEM_LINK_LIVE = 1,
  TANDEM_LINK_STALE = 2,
  TANDEM_LINK_FADING = 3,
  TANDEM_LINK_LOST = 4,
  TANDEM_LINK_REJOINING = 5
} TandemLinkState;

/* What a site shows at one moment. */
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
} TandemReading;

/* Objects and proxies as the island has them. `objects` has room for `object_room` states, in the
   order of sharing, `proxies` and `links` for `remote_room` in the order of connecting; what does
   not fit is left out, null: none. Where a scheme has no proxy its state is all NAN. [host]; with a
   loop it waits for the end of a tick. */
TandemResult tandem_site_read(TandemSite* site, TandemReading* reading, size_t object_room,
                              TandemState* objects, size_t remote_room, TandemState* proxies,
                              TandemLinkState* links);

/* What a user should know about what was attached, and what the system did not grant a loop, one
   line each. Writes at most `room` bytes with the 0, and to `length` (or null) how many there are
   without it. [setup] */
TandemResult tandem_site_warnings(const TandemSite* site, char* text, size_t room, size_t* length);

#if defined(__GNUC__)
#pragma GCC visibility pop
#endif

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* TANDEM_TANDEM_H */
