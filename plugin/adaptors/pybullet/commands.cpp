#include "commands.h"

#include <cmath>
#include <cstring>
#include <exception>
#include <string_view>

#include "packet_doubles.h"
#include "refusal.h"

namespace tandem::pybullet {
namespace {

/// Coordinates that may wait for their command: a hull of 341 points.
constexpr std::size_t kMostWords = 2048;

void put(Reply& reply, const double* values, std::size_t size) {
  reply.bytes.append(reinterpret_cast<const char*>(values), size * sizeof(double));
}

void put(Reply& reply, double value) { put(reply, &value, 1); }

void put(Reply& reply, const TandemState& state) {
  put(reply, state.position, 3);
  put(reply, state.orientation, 4);
  put(reply, state.velocity, 3);
  put(reply, state.angular_velocity, 3);
}

void putText(Reply& reply, const std::string& text) {
  reply.type = b3::kString;
  reply.bytes = text;
}

std::uint32_t toId(Words& words, const char* key) {
  const int id = words.integer(key);
  if (id < 1) throw Refusal(kBadCommand, std::string(key) + ": 1 or more");
  return static_cast<std::uint32_t>(id);
}

}  // namespace

const Commands::Entry Commands::kTable[] = {
    {"version", &Commands::version, false},
    {"data", &Commands::data, true},
    {"device", &Commands::device, false},
    {"site", &Commands::site, false},
    {"peer", &Commands::peer, false},
    {"agree", &Commands::agree, false},
    {"mesh", &Commands::mesh, false},
    {"mesh_status", &Commands::meshStatus, false},
    {"mesh_explain", &Commands::meshExplain, false},
    {"key", &Commands::key, false},
    {"link", &Commands::link, false},
    {"share", &Commands::share, true},
    {"obstacle", &Commands::obstacle, true},
    {"connect", &Commands::connect, false},
    {"proxy", &Commands::proxy, false},
    {"hand", &Commands::hand, false},
    {"force", &Commands::force, false},
    {"read", &Commands::read, false},
    {"warnings", &Commands::warnings, false},
    {"push", &Commands::push, true},
    {"pop", &Commands::pop, false},
    {"close", &Commands::close, false},
};

Reply Commands::run(const b3::PluginArguments& arguments) noexcept {
  Reply reply;
  try {
    try {
      return runWords(arguments);
    } catch (const Refusal& why) {
      reply.status = why.status();
      putText(reply, why.what());
    } catch (const std::exception& why) {
      reply.status = -TANDEM_INTERNAL;
      putText(reply, why.what());
    }
    data_.clear();
  } catch (...) {
    // No memory for the text.
    reply.status = -TANDEM_NO_MEMORY;
  }
  return reply;
}

Reply Commands::runWords(const b3::PluginArguments& arguments) {
  Words words(std::string_view(arguments.text, strnlen(arguments.text, sizeof arguments.text)));
  for (const Entry& entry : kTable) {
    if (words.name() != entry.name) continue;
    if (arguments.float_count != 0) {
      throw Refusal(kBadCommand, words.name() +
                                     ": PyBullet rounds floatArgs to single precision: numbers go "
                                     "into the text, doubles as pairs of words into intArgs");
    }
    if (arguments.int_count < 0 || arguments.int_count > 128 ||
        (arguments.int_count > 0 && !entry.takes_data)) {
      throw Refusal(kBadCommand, words.name() + ": it takes no intArgs");
    }
    data_.insert(data_.end(), arguments.ints, arguments.ints + arguments.int_count);
    if (data_.size() > kMostWords) {
      throw Refusal(kBadCommand, "data: more than " + std::to_string(kMostWords) + " words");
    }
    Reply reply;
    (this->*entry.function)(words, reply);
    if (entry.function != &Commands::data) data_.clear();
    return reply;
  }
  std::string all;
  for (const Entry& entry : kTable) all += std::string(all.empty() ? "" : ", ") + entry.name;
  throw Refusal(kBadCommand, "\"" + words.name() + "\" is no command; there are: " + all);
}

std::vector<double> Commands::takeDoubles() {
  if (data_.size() % 2 != 0)
    throw Refusal(kBadCommand, "intArgs: a double is two words of 32 bits");
  std::vector<double> doubles(data_.size() / 2);
  if (!doubles.empty()) std::memcpy(doubles.data(), data_.data(), data_.size() * sizeof(int));
  data_.clear();
  return doubles;
}

void Commands::version(Words& words, Reply& reply) {
  words.finish();
  putText(reply, tandem_version());
}

void Commands::data(Words& words, Reply& reply) {
  words.finish();
  reply.status = static_cast<int>(data_.size());
}

void Commands::peer(Words& words, Reply&) {
  Peer peer{toId(words, "id"), words.text("address", ""), words.text("key")};
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

void Commands::mesh(Words& words, Reply&) {
  const std::uint32_t self = toId(words, "self");
  const std::string bind = words.text("bind");
  words.finish();
  std::vector<TandemMeshPeer> peers;
  for (const Peer& peer : peers_) {
    peers.push_back(
        {peer.id, peer.address.empty() ? nullptr : peer.address.c_str(), peer.key.c_str()});
  }
  std::vector<TandemAgreement> items;
  for (const Item& item : agreements_) items.push_back({item.key.c_str(), item.value.c_str()});
  TandemMesh* mesh = nullptr;
  check(tandem_mesh_create(self, bind.c_str(), peers.size(), peers.data(), items.size(),
                           items.data(), &mesh));
  session_.addMesh(MeshHandle(mesh));
  peers_.clear();
  agreements_.clear();
}

void Commands::link(Words& words, Reply& reply) {
  const std::string kind = words.text("kind");
  if (kind == "manual") {
    words.finish();
    reply.status = session_.addManualLink();
  } else if (kind == "mesh") {
    const std::uint32_t peer = toId(words, "peer");
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

void Commands::share(Words& words, Reply& reply) {
  const int body = words.integer("body");
  const double damping = words.number("damping", 0.0);
  const std::optional<Piece> shape = readPieceFromWords(words, takeDoubles());
  words.finish();
  reply.status = session_.share(body, damping, shape ? &*shape : nullptr);
}

void Commands::obstacle(Words& words, Reply&) {
  const int body = words.integer("body");
  const std::optional<Piece> shape = readPieceFromWords(words, takeDoubles());
  words.finish();
  session_.addObstacle(body, shape ? &*shape : nullptr);
}

void Commands::connect(Words& words, Reply& reply) {
  const std::uint32_t peer = toId(words, "peer");
  const int link = words.integer("link");
  double start[3]{};
  words.numbers("start", start, 3);
  words.finish();
  reply.status = session_.connect(peer, link, start);
}

void Commands::proxy(Words& words, Reply&) {
  const int remote = words.integer("remote");
  const int body = words.integer("body");
  words.finish();
  session_.showProxy(remote, body);
}

void Commands::hand(Words& words, Reply&) {
  TandemDevice* const device = session_.device();
  if (!device) throw Refusal(kWrongOrder, "hand: there is no device yet");
  double position[3]{}, velocity[3]{}, force[3]{};
  if (session_.deviceIsMoved()) {
    words.numbers("position", position, 3);
    words.numbers("velocity", velocity, 3);
    words.finish();
    check(tandem_device_move(device, position, velocity));
  } else {
    words.numbers("force", force, 3);
    words.finish();
    check(tandem_device_set_hand(device, force));
  }
}

void Commands::force(Words& words, Reply& reply) {
  words.finish();
  SessionReading reading;
  session_.read(reading);
  put(reply, reading.reading.force, 3);
}

void Commands::read(Words& words, Reply& reply) {
  words.finish();
  SessionReading all;
  session_.read(all);
  const TandemReading& reading = all.reading;
  put(reply, reading.force, 3);
  put(reply, reading.hip, 3);
  put(reply, reading.hip_velocity, 3);
  put(reply, static_cast<double>(reading.ticks));
  put(reply, static_cast<double>(reading.status));
  put(reply, static_cast<double>(reading.state_hash >> 32U));
  put(reply, static_cast<double>(reading.state_hash & 0xFFFFFFFFU));
  put(reply, static_cast<double>(reading.packets_sent));
  put(reply, static_cast<double>(reading.packets_taken));
  put(reply, all.has_ended ? 1.0 : 0.0);
  put(reply, static_cast<double>(all.objects.size()));
  put(reply, static_cast<double>(all.proxies.size()));
  for (const TandemState& state : all.objects) put(reply, state);
  for (const TandemState& state : all.proxies) put(reply, state);
  for (const TandemLinkState state : all.links) put(reply, static_cast<double>(state));
}

void Commands::warnings(Words& words, Reply& reply) {
  words.finish();
  putText(reply, session_.warnings());
}

void Commands::meshStatus(Words& words, Reply& reply) {
  const std::uint32_t peer = toId(words, "peer");
  words.finish();
  const TandemPeerStatus status = session_.meshStatus(peer);
  put(reply, static_cast<double>(status.phase));
  put(reply, status.silence);
  put(reply, status.round_trip);
  put(reply, status.loss);
}

void Commands::meshExplain(Words& words, Reply& reply) {
  const std::uint32_t peer = toId(words, "peer");
  words.finish();
  putText(reply, session_.explainPeer(peer));
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
  put(reply, doubles.data(), doubles.size());
}

void Commands::close(Words& words, Reply&) {
  words.finish();
  session_.close();
}

}  // namespace tandem::pybullet
