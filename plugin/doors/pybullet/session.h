#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tandem/tandem.h"

#include "borrowed_body.h"
#include "engine.h"
#include "link_table.h"
#include "shapes.h"

namespace tandem::pybullet {

struct WorldDeleter {
  void operator()(TandemWorld* world) const { (void)tandem_world_destroy(world); }
};
struct DeviceDeleter {
  void operator()(TandemDevice* device) const { (void)tandem_device_destroy(device); }
};
struct SiteDeleter {
  void operator()(TandemSite* site) const { (void)tandem_site_destroy(site); }
};
struct MeshDeleter {
  void operator()(TandemMesh* mesh) const { (void)tandem_mesh_destroy(mesh); }
};
using WorldHandle = std::unique_ptr<TandemWorld, WorldDeleter>;
using DeviceHandle = std::unique_ptr<TandemDevice, DeviceDeleter>;
using SiteHandle = std::unique_ptr<TandemSite, SiteDeleter>;
using MeshHandle = std::unique_ptr<TandemMesh, MeshDeleter>;

/// State of a site; the force is zero after its end.
struct SessionReading {
  TandemReading reading{};
  std::vector<TandemState> objects, proxies;
  std::vector<int> links;  // TandemLinkState, or a mesh peer's phase, see Session::tellLink()
  bool has_ended = false;
};

/// One user's site in one physics server.
///
///     PyBullet's world                          a world of Tandem's
///       cube      -- now, handed over, after --   guest, shared
///       sphere    ------------------------------  proxy of a remote     in each internal step
///       floor     -- pose, when it is moved ----  guest, static
///
/// Set-up throws Refusal and then changes nothing. Thread: the server's, for all calls.
class Session {
 public:
  Session(const B3Functions& functions, b3::Client client);
  /// Ends the site but does not touch PyBullet's bodies, see Engine. close() restores them.
  ~Session();

  // Order of set-up: device, site, then links and bodies.
  void takeDevice(DeviceHandle device, bool is_moved);
  void openSite(const TandemSiteSettings& settings);
  void addMesh(MeshHandle mesh);
  int addManualLink();
  int addMeshLink(std::uint32_t peer);
  int addSimulatedLink(const std::string& name, const TandemNetwork& network);

  /// Shares the base of a body without joints. `shape` replaces PyBullet's shape, if given. Returns
  /// the number of the object.
  int share(int body, double damping, const Piece* shape);
  /// Gives a user a tool, held by its place `at`; else as share().
  int shareTool(int body, std::uint32_t user, const double at[3], const Piece* shape);
  /// Shares a body for an object that has none, after unshare() or because its body was removed.
  void shareAgain(int object, int body, const Piece* shape);
  /// Gives a shared object back to PyBullet; the others stay shared. Does nothing if it has no
  /// body.
  void unshare(int object);
  /// The hand holds a shared body; `at`: by this place, or null.
  void grab(int object, const double* at);
  void release();
  [[nodiscard]] TandemGrip grip();
  /// Adds a static body that shared objects, proxies and the hand can touch.
  void addObstacle(int body, const Piece* shape);
  int connect(std::uint32_t peer, int link, const double start[3]);
  /// Moves a sphere of PyBullet's with a remote's proxy and its mass, so that it pushes other
  /// bodies.
  void showProxy(int remote, int body);

  /// Restores all bodies and ends the site, its links and its device.
  void close();

  bool hasBodies() const { return !moving_.empty() || !standing_.empty(); }
  TandemDevice* device() const { return device_.get(); }
  bool deviceIsMoved() const { return device_is_moved_; }
  TandemPeerStatus meshStatus(std::uint32_t peer) const;
  std::string explainPeer(std::uint32_t peer) const;
  TandemLink* manualLink(int link) const;
  void read(SessionReading& reading) const;
  /// Contacts in Tandem's world, of which PyBullet does not know. Its bodies have PyBullet's
  /// numbers there; -1: a body that PyBullet does not have.
  struct Contact {
    int body_a, body_b;
    TandemContact in_tandem;
  };
  std::vector<Contact> contacts() const;
  /// Facts that a user should know, one line each: from set-up, and since then.
  std::string warnings() const;

  /// Called before and after each internal step of PyBullet. A failure ends the site with a
  /// warning.
  void preTick() noexcept;
  void postTick() noexcept;

 private:
  static constexpr int kProxy = -1;
  struct Moving {
    BorrowedBody body;
    TandemBody id;
    TandemState set;         // state that PyBullet was told last
    int object = kProxy;     // its number
    bool has_stood = false;  // did not move in the last step, despite its velocity
    bool is_gone = false;    // removed from PyBullet during the step
  };
  struct Standing {
    BorrowedBody body;
    std::vector<Piece> pieces;
    std::vector<TandemBody> ids;
    TandemState pose;
  };
  struct OpenLink {
    LinkHandle manual;
    std::unique_ptr<SimulatedEnd> simulated;
    TandemLink* handle = nullptr;
    std::uint32_t mesh_peer = 0;  // 0: no link of the mesh
  };

  void requireNoSite() const;
  void requireOpen() const;
  void requireSite() const;
  void requireFree(int body) const;
  void stopContact(int body_a, int body_b);
  void stopContactWithAll(int body);
  std::vector<Piece> findPieces(const BorrowedBody& body, const Piece* shape) const;
  static void describeGuest(const BorrowedBody& body, const TandemState& state,
                            TandemBodySettings& settings);
  TandemBody addGuest(const BorrowedBody& body, Piece& piece, const TandemState& state);
  TandemBody addGuest(const BorrowedBody& body, const std::vector<Piece>& pieces,
                      const TandemState& state);
  void finishGuest(TandemBody id, const BodyFacts& facts);
  void addMoving(BorrowedBody body, TandemBody id, const TandemState& state, int object);
  template <typename ShareGuest>
  int shareGuest(int body, double mass_share, const Piece* shape, ShareGuest share);
  std::size_t findObject(int object) const;
  int findBody(TandemBody id) const;
  void release(std::size_t moving, bool is_there);
  void lose(std::size_t moving, BorrowedBody::Presence presence);
  void loseObstacle(std::size_t standing, BorrowedBody::Presence presence);
  void restoreContact(int body);
  bool keep(std::size_t moving);
  bool keepObstacle(std::size_t standing);
  void tellDynamics(TandemBody id, const BodyFacts& facts);
  int keepLink(OpenLink link);
  EngineParameters askParameters() const;
  void begin();
  void finish();
  void sayFarewell(int rounds);
  void lookAtOne();
  BorrowedBody::Presence look(BorrowedBody& body);
  void readMoving();
  void watchStep(Moving& one, const TandemState& after);
  void explainStanding(Moving& one, const TandemState& now);
  int tellLink(std::size_t remote, TandemLinkState state) const;
  void warn(const std::string& text);
  void end(const std::string& why);
  void runSafely(void (Session::*part)()) noexcept;

  Engine engine_;
  EngineParameters parameters_;
  int peers_ = 1;
  double proxy_mass_ = 0.0;  // [kg]
  bool device_is_moved_ = false;
  bool is_between_ = false;  // between pre-tick and post-tick
  bool has_warned_of_step_ = false;
  std::string ended_;  // reason; "" while the site runs
  std::vector<std::string> warnings_;
  std::vector<int> tools_;      // objects that are tools: each copy has its whole mass
  std::vector<int> lost_;       // objects whose body went away
  bool has_ever_lost_ = false;  // since the start
  std::vector<Moving> moving_;
  std::vector<Standing> standing_;
  std::size_t next_look_ = 0;
  std::vector<TandemBody> proxies_;
  std::vector<std::uint32_t> mesh_peers_;  // of the remotes; 0: no peer of the mesh
  std::vector<std::pair<int, int>> without_contact_;
  std::vector<TandemBody> ids_;
  std::vector<TandemState> now_, told_;

  // Order of destruction: the last member goes first.
  MeshHandle mesh_;
  std::vector<OpenLink> links_;
  DeviceHandle device_;
  WorldHandle world_;
  SiteHandle site_;
};

}  // namespace tandem::pybullet
