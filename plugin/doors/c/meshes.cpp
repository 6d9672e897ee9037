#include <algorithm>
#include <string>

#include "tandem/plugin/key_file.h"

#include "c/mesh.h"
#include "c/values.h"

namespace tandem::c_door {
namespace {

static_assert(TANDEM_PEER_CALLING == static_cast<int>(PeerPhase::kCalling));
static_assert(TANDEM_PEER_AGREEING == static_cast<int>(PeerPhase::kAgreeing));
static_assert(TANDEM_PEER_DIFFERENT == static_cast<int>(PeerPhase::kDifferent));
static_assert(TANDEM_PEER_LIVE == static_cast<int>(PeerPhase::kLive));
static_assert(TANDEM_PEER_LEFT == static_cast<int>(PeerPhase::kLeft));

[[nodiscard]] std::vector<UdpPeer> readPeers(std::size_t count, const TandemMeshPeer* peers) {
  if (count > 0) checkPointer(peers, "peers");
  std::vector<UdpPeer> read;
  for (std::size_t i = 0; i < count; ++i) {
    std::optional<Address> address;
    if (peers[i].address) address = resolveAddress(peers[i].address);
    read.push_back({PeerId{peers[i].id}, address,
                    readKeyFile(&checkPointer(peers[i].key_file, "key_file of a peer"))});
  }
  return read;
}

[[nodiscard]] Configuration readAgreements(std::size_t count, const TandemAgreement* agreements) {
  if (count > 0) checkPointer(agreements, "agreements");
  std::vector<ConfigurationItem> items;
  for (std::size_t i = 0; i < count; ++i)
    items.push_back({&checkPointer(agreements[i].key, "key of an agreement"),
                     &checkPointer(agreements[i].value, "value of an agreement")});
  return makeConfiguration(std::move(items));
}

[[nodiscard]] std::vector<std::uint32_t> listIds(const std::vector<UdpPeer>& peers) {
  std::vector<std::uint32_t> ids;
  for (const UdpPeer& peer : peers) ids.push_back(static_cast<std::uint32_t>(peer.id));
  return ids;
}

}  // namespace

MeshEnd::MeshEnd(const UdpMeshSettings& settings, std::vector<UdpPeer> peers)
    : ids_(listIds(peers)), peers_(settings, std::move(peers)) {}

MeshEnd::~MeshEnd() {
  for (const Way& way : ways_) Shells<TandemLink>::all().discard(*way.handle);
}

TandemLink* MeshEnd::link(std::uint32_t peer, HandleHead& own) {
  checkPeer(peer);
  for (const Way& way : ways_)
    if (way.peer == peer) return way.handle;
  ways_.reserve(ways_.size() + 1);
  auto end = std::make_unique<LinkEnd>();
  end->link = &peers_.link(PeerId{peer});
  end->mesh = MeshWay{&own, &peers_, PeerId{peer}};
  ways_.push_back({peer, Shells<TandemLink>::all().wrap(std::move(end))});
  return ways_.back().handle;
}

void MeshEnd::follow(double now) {
  requireFinite("now", now);
  if (has_begun_ && now < now_) refuseValue("now", now, "no earlier than it was before");
  now_ = now;
  has_begun_ = true;
}

void MeshEnd::poll(double now) {
  follow(now);
  peers_.poll(now);
}

void MeshEnd::leave(double now) {
  follow(now);
  peers_.leave(now);
}

void MeshEnd::checkPeer(std::uint32_t peer) const {
  if (std::find(ids_.begin(), ids_.end(), peer) == ids_.end())
    refuseValue("peer", peer, "one of the peers that the mesh was created with");
}

std::vector<std::string> MeshEnd::explain(std::uint32_t peer) const {
  checkPeer(peer);
  const PeerStatus status = peers_.status(PeerId{peer}, now_);
  const auto show = [](const std::string& value) { return value.empty() ? "missing" : value; };
  std::vector<std::string> lines;
  if (const auto& d = status.difference)
    lines.push_back(d->key + " is " + show(d->here) + " here and " + show(d->there) +
                    " there; make it the same");
  if (status.refused)
    lines.push_back(std::string("it refuses us: ") + tandem::explain(*status.refused));
  return lines;
}

TandemPeerStatus MeshEnd::status(std::uint32_t peer, double now) const {
  checkPeer(peer);
  requireFinite("now", now);
  const PeerStatus status = peers_.status(PeerId{peer}, now);
  return {static_cast<TandemPeerPhase>(status.phase), status.silence, status.round_trip,
          status.loss};
}

}  // namespace tandem::c_door

using namespace tandem;          // NOLINT: the functions of the header are in no namespace
using namespace tandem::c_door;  // NOLINT

extern "C" {

TandemResult tandem_key_create(const char* path) {
  return guarded([&] { makeKeyFile(&checkPointer(path, "path")); });
}

TandemResult tandem_mesh_create(uint32_t self, const char* bind, size_t peer_count,
                                const TandemMeshPeer* peers, size_t agreement_count,
                                const TandemAgreement* agreements, TandemMesh** mesh) {
  return guarded([&] {
    auto& out = checkPointer(mesh, "mesh");
    if (self == 0) refuseValue("self", 0, "1 or more, another one at each site");
    UdpMeshSettings settings;
    settings.self = PeerId{self};
    settings.configuration = readAgreements(agreement_count, agreements);
    std::vector<UdpPeer> read = readPeers(peer_count, peers);
    settings.bind = resolveAddress(&checkPointer(bind, "bind"));
    out = Shells<TandemMesh>::all().wrap(std::make_unique<MeshEnd>(settings, std::move(read)));
  });
}

TandemResult tandem_mesh_port(const TandemMesh* mesh, uint16_t* port) {
  return guarded([&] {
    const MeshEnd& of = open(mesh);
    checkPointer(port, "port") = of.port();
  });
}

TandemResult tandem_mesh_link(TandemMesh* mesh, uint32_t peer, TandemLink** link) {
  return guarded([&] {
    MeshEnd& of = open(mesh);
    checkPointer(link, "link") = of.link(peer, mesh->head);
  });
}

TandemResult tandem_mesh_poll(TandemMesh* mesh, double now) {
  return guarded([&] { open(mesh).poll(now); });
}

TandemResult tandem_mesh_status(const TandemMesh* mesh, uint32_t peer, double now,
                                TandemPeerStatus* status) {
  return guarded([&] {
    const MeshEnd& of = open(mesh);
    checkPointer(status, "status") = of.status(peer, now);
  });
}

TandemResult tandem_mesh_explain(const TandemMesh* mesh, uint32_t peer, char* text, size_t room,
                                 size_t* length) {
  return guarded([&] { writeLines(open(mesh).explain(peer), text, room, length); });
}

TandemResult tandem_mesh_leave(TandemMesh* mesh, double now) {
  return guarded([&] { open(mesh).leave(now); });
}

TandemResult tandem_mesh_destroy(TandemMesh* mesh) {
  return guarded([&] { Shells<TandemMesh>::all().destroy(mesh); });
}

}  // extern "C"
