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

/// What a site shows; all zero force after the end.
struct SessionReading {
  TandemReading reading{};
  std::vector<TandemState> objects, proxies;
  std::vector<TandemLinkState> links;
  bool has_ended = false;
};

/// One user's site in one physics server.
///
///     PyBullet's world                          a world of Tandem's
///       cube      -- now, handed over, after --   guest, shared
///       sphere    ------------------------------  proxy of a remote     in each internal step
///       floor     -- pose, when it is moved ----  guest, static
///
/// Set-up throws Refusal and then has changed nothing. Thread: the server's, for everything.
class Session {
 public:
  Session(const B3Functions& functions, b3::Client client);
  /// Ends the site. PyBullet's bodies are not touched, see Engine; close() gives them back.
  ~Session();

  // Order of set-up: device, site; then links and bodies.
  void takeDevice(DeviceHandle device, bool is_moved);
  void openSite(const TandemSiteSettings& settings);
  void addMesh(MeshHandle mesh);
  int addManualLink();
  int addMeshLink(std::uint32_t peer);
  int addSimulatedLink(const std::string& name, const TandemNetwork& network);

  /// Shares the base of a body without joints. `shape` if PyBullet's answer will not do.
  int share(int body, double damping, const Piece* shape);
  /// A static body that shared objects, proxies and the hand shall meet.
  void addObstacle(int body, const Piece* shape);
  int connect(std::uint32_t peer, int link, const double start[3]);
  /// Lets a sphere of PyBullet's go where a remote's proxy is, and push what PyBullet has there,
  /// with the proxy's mass.
  void showProxy(int remote, int body);

  /// Gives all bodies back and ends the site, its links and its device.
  void close();

  bool hasBodies() const { return !moving_.empty() || !standing_.empty(); }
  TandemDevice* device() const { return device_.get(); }
  bool deviceIsMoved() const { return device_is_moved_; }
  TandemPeerStatus meshStatus(std::uint32_t peer) const;
  std::string explainPeer(std::uint32_t peer) const;
  TandemLink* manualLink(int link) const;
  void read(SessionReading& reading) const;
  /// What a user should know, one line each: of set-up, and since.
  std::string warnings() const;

  /// Before and after each internal step of PyBullet. What fails ends the site with a warning.
  void preTick() noexcept;
  void postTick() noexcept;

 private:
  struct Moving {
    BorrowedBody body;
    TandemBody id;
    TandemState set;  // as PyBullet was told last
  };
  struct Standing {
    BorrowedBody body;
    std::vector<Piece> pieces;
    std::vector<TandemBody> ids;
    TandemState pose;
  };
  struct Link {
    LinkHandle manual;
    std::unique_ptr<SimulatedEnd> simulated;
    TandemLink* handle = nullptr;
  };

  void requireOpen() const;
  void requireSite() const;
  void requireFree(int body) const;
  void stopContact(int body_a, int body_b);
  void stopContactWithAll(int body);
  std::vector<Piece> findPieces(const BorrowedBody& body, const Piece* shape) const;
  TandemBody addGuest(const BorrowedBody& body, Piece& piece, const TandemState& state);
  void addMoving(BorrowedBody body, TandemBody id, const TandemState& state);
  int keepLink(Link link);
  EngineParameters askParameters() const;
  void begin();
  void finish();
  void sayFarewell(int rounds);
  void lookAtOne();
  bool isSame(BorrowedBody& body);
  void watchStep(const TandemState& before, const TandemState& after);
  void warn(const std::string& text);
  void end(const std::string& why);
  void runSafely(void (Session::*part)()) noexcept;

  Engine engine_;
  EngineParameters parameters_;
  int peers_ = 1;
  double proxy_mass_ = 0.0;  // [kg]
  bool device_is_moved_ = false;
  bool is_between_ = false;  // pre-tick and post-tick
  bool has_warned_of_step_ = false;
  std::string ended_;  // why; "" while all is well
  std::vector<std::string> warnings_;
  std::vector<Moving> moving_;
  std::vector<Standing> standing_;
  std::size_t next_look_ = 0;
  std::vector<TandemBody> proxies_;
  std::vector<std::pair<int, int>> without_contact_;
  std::vector<TandemBody> ids_;
  std::vector<TandemState> now_, told_;

  // In this order: the last is destroyed first.
  MeshHandle mesh_;
  std::vector<Link> links_;
  DeviceHandle device_;
  WorldHandle world_;
  SiteHandle site_;
};

}  // namespace tandem::pybullet
