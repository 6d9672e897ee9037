#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tandem/plugin/live_peers.h"

#include "c/link.h"

namespace tandem::c_door {

/// A mesh and the handles of its links.
class MeshEnd {
 public:
  static constexpr std::uint32_t kKind = 0x54654d53;
  static constexpr const char* kName = "mesh";
  static constexpr const char* kUser = "a site, by one of its links";

  MeshEnd(const UdpMeshSettings& settings, std::vector<UdpPeer> peers);
  ~MeshEnd();
  MeshEnd(const MeshEnd&) = delete;
  MeshEnd& operator=(const MeshEnd&) = delete;

  /// Returns the same handle each time. `own` is the handle of this mesh.
  [[nodiscard]] TandemLink* link(std::uint32_t peer, HandleHead& own);
  [[nodiscard]] std::uint16_t port() const noexcept { return peers_.bound().port; }
  void poll(double now);
  void leave(double now);
  [[nodiscard]] TandemPeerStatus status(std::uint32_t peer, double now) const;
  [[nodiscard]] std::vector<std::string> explain(std::uint32_t peer) const;

 private:
  struct Way {
    std::uint32_t peer;
    TandemLink* handle;
  };
  void follow(double now);
  void checkPeer(std::uint32_t peer) const;

  std::vector<std::uint32_t> ids_;
  LivePeers peers_;
  std::vector<Way> ways_;
  double now_ = 0.0;
  bool has_begun_ = false;
};

}  // namespace tandem::c_door

struct TandemMesh : tandem::c_door::Handle<tandem::c_door::MeshEnd> {};
