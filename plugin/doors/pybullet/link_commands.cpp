#include <utility>

#include "commands.h"
#include "packet_doubles.h"
#include "refusal.h"

namespace tandem::pybullet {

void Commands::peer(Words& words, Reply&) {
  Peer peer{words.id("id"), words.text("address", ""), words.text("key")};
  words.finish();
  peers_.push_back(std::move(peer));
}

void Commands::agree(Words& words, Reply&) {
  Item item{words.text("key"), words.text("value")};
  words.finish();
  agreements_.push_back(std::move(item));
}

void Commands::key(Words& words, Reply&) {
  const std::string path = words.text("path");
  words.finish();
  check(tandem_key_create(path.c_str()));
}

// Peers and agreements belong to this mesh only, also if it fails.
void Commands::mesh(Words& words, Reply&) {
  const std::vector<Peer> said_peers = std::exchange(peers_, {});
  const std::vector<Item> said_items = std::exchange(agreements_, {});
  const std::uint32_t self = words.id("self");
  const std::string bind = words.text("bind");
  words.finish();
  std::vector<TandemMeshPeer> peers;
  for (const Peer& peer : said_peers) {
    peers.push_back(
        {peer.id, peer.address.empty() ? nullptr : peer.address.c_str(), peer.key.c_str()});
  }
  std::vector<TandemAgreement> items;
  for (const Item& item : said_items) items.push_back({item.key.c_str(), item.value.c_str()});
  TandemMesh* mesh = nullptr;
  check(tandem_mesh_create(self, bind.c_str(), peers.size(), peers.data(), items.size(),
                           items.data(), &mesh));
  session_.addMesh(MeshHandle(mesh));
}

void Commands::meshStatus(Words& words, Reply& reply) {
  const std::uint32_t peer = words.id("peer");
  words.finish();
  const TandemPeerStatus status = session_.meshStatus(peer);
  reply.put(static_cast<double>(status.phase));
  reply.put(status.silence);
  reply.put(status.round_trip);
  reply.put(status.loss);
}

void Commands::meshExplain(Words& words, Reply& reply) {
  const std::uint32_t peer = words.id("peer");
  words.finish();
  reply.putText(session_.explainPeer(peer));
}

void Commands::link(Words& words, Reply& reply) {
  const std::string kind = words.text("kind");
  if (kind == "manual") {
    words.finish();
    reply.status = session_.addManualLink();
  } else if (kind == "mesh") {
    const std::uint32_t peer = words.id("peer");
    words.finish();
    reply.status = session_.addMeshLink(peer);
  } else if (kind == "simulated") {
    const std::string name = words.text("name");
    TandemNetwork network{};
    network.delay = words.number("delay", 0.0);
    network.jitter = words.number("jitter", 0.0);
    network.loss = words.number("loss", 0.0);
    network.duplicate = words.number("duplicate", 0.0);
    network.reorder = words.number("reorder", 0.0);
    network.seed = words.count("seed", 1);
    words.finish();
    reply.status = session_.addSimulatedLink(name, network);
  } else {
    throw Refusal(kBadCommand, "kind=" + kind + ": there are simulated, manual and mesh");
  }
}

void Commands::push(Words& words, Reply&) {
  TandemLink* const link = session_.manualLink(words.integer("link"));
  words.finish();
  const TandemPacket packet = toPacket(takeDoubles());
  check(tandem_link_push(link, &packet));
}

void Commands::pop(Words& words, Reply& reply) {
  TandemLink* const link = session_.manualLink(words.integer("link"));
  words.finish();
  TandemPacket packet{};
  check(tandem_link_pop(link, &packet, &reply.status));
  if (reply.status == 0) return;
  const std::vector<double> doubles = toDoubles(packet);
  reply.put(doubles.data(), doubles.size());
}

void Commands::connect(Words& words, Reply& reply) {
  const std::uint32_t peer = words.id("peer");
  const int link = words.integer("link");
  double start[3]{};
  words.numbers("start", start, 3);
  words.finish();
  reply.status = session_.connect(peer, link, start);
}

}  // namespace tandem::pybullet
