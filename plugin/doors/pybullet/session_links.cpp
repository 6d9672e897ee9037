#include "tandem/falcon/monotonic_clock.h"

#include "refusal.h"
#include "session.h"

namespace tandem::pybullet {

void Session::addMesh(MeshHandle mesh) {
  if (mesh_) throw Refusal(kWrongOrder, "there is a mesh already: `close` first");
  mesh_ = std::move(mesh);
}

TandemPeerStatus Session::meshStatus(std::uint32_t peer) const {
  if (!mesh_) throw Refusal(kWrongOrder, "there is no mesh");
  TandemPeerStatus status{};
  check(tandem_mesh_status(mesh_.get(), peer, readMonotonicClock(), &status));
  return status;
}

std::string Session::explainPeer(std::uint32_t peer) const {
  if (!mesh_) throw Refusal(kWrongOrder, "there is no mesh");
  std::size_t length = 0;
  check(tandem_mesh_explain(mesh_.get(), peer, nullptr, 0, &length));
  std::string text(length + 1, '\0');
  check(tandem_mesh_explain(mesh_.get(), peer, text.data(), text.size(), &length));
  text.resize(length);
  return text;
}

int Session::keepLink(OpenLink link) {
  links_.push_back(std::move(link));
  return static_cast<int>(links_.size()) - 1;
}

int Session::addManualLink() {
  OpenLink link;
  check(tandem_link_create_manual(&link.handle));
  link.manual.reset(link.handle);
  return keepLink(std::move(link));
}

int Session::addMeshLink(std::uint32_t peer) {
  if (!mesh_) throw Refusal(kWrongOrder, "a link of kind mesh needs a mesh: `mesh` first");
  OpenLink link;
  check(tandem_mesh_link(mesh_.get(), peer, &link.handle));
  link.mesh_peer = peer;
  return keepLink(std::move(link));
}

int Session::addSimulatedLink(const std::string& name, const TandemNetwork& network) {
  OpenLink link;
  link.simulated = std::make_unique<SimulatedEnd>(name, network);
  link.handle = link.simulated->link();
  return keepLink(std::move(link));
}

TandemLink* Session::manualLink(int link) const {
  if (link < 0 || link >= static_cast<int>(links_.size()) ||
      !links_[static_cast<std::size_t>(link)].manual) {
    throw Refusal(kBadCommand, "link=" + std::to_string(link) + " is no manual link");
  }
  return links_[static_cast<std::size_t>(link)].handle;
}

int Session::connect(std::uint32_t peer, int link, const double start[3]) {
  requireSite();
  if (link < 0 || link >= static_cast<int>(links_.size())) {
    throw Refusal(kBadCommand, "link=" + std::to_string(link) + ": no such link");
  }
  TandemBody proxy = TANDEM_NO_BODY;
  check(tandem_site_connect(site_.get(), peer, links_[static_cast<std::size_t>(link)].handle, start,
                            &proxy));
  proxies_.push_back(proxy);
  mesh_peers_.push_back(links_[static_cast<std::size_t>(link)].mesh_peer);
  return static_cast<int>(proxies_.size()) - 1;
}

// The site counts a peer as live at its start until it is heard. So the phase of a mesh's peer that
// is not live stands in the place of the link's state, behind the states.
int Session::tellLink(std::size_t remote, TandemLinkState state) const {
  const std::uint32_t peer = mesh_peers_[remote];
  if (peer == 0) return state;
  const TandemPeerPhase phase = meshStatus(peer).phase;
  if (phase == TANDEM_PEER_LIVE) return state;
  constexpr int kFirstPhase = TANDEM_LINK_REJOINING + 1;
  return kFirstPhase + static_cast<int>(phase);
}

void Session::sayFarewell(int rounds) {
  if (!mesh_ || tandem_mesh_leave(mesh_.get(), readMonotonicClock()) != TANDEM_OK) return;
  for (int round = 0; round < rounds; ++round) {
    if (round > 0) sleepFor(0.01);
    (void)tandem_mesh_poll(mesh_.get(), readMonotonicClock());
  }
}

}  // namespace tandem::pybullet
