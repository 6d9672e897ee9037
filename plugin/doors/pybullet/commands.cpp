#include "commands.h"

#include <cstring>
#include <exception>
#include <string_view>

#include "refusal.h"

namespace tandem::pybullet {
namespace {

/// Limits of the data sent before a command: x, y, z of each hull point, two words per double.
constexpr std::size_t kMostPoints = 4096;
constexpr std::size_t kMostWords = kMostPoints * 3 * 2;

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
    {"unshare", &Commands::unshare, false},
    {"grab", &Commands::grab, false},
    {"release", &Commands::release, false},
    {"grip", &Commands::grip, false},
    {"obstacle", &Commands::obstacle, true},
    {"connect", &Commands::connect, false},
    {"proxy", &Commands::proxy, false},
    {"hand", &Commands::hand, false},
    {"force", &Commands::force, false},
    {"read", &Commands::read, false},
    {"contacts", &Commands::contacts, false},
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
      reply.putText(why.what());
    } catch (const std::exception& why) {
      reply.status = -TANDEM_INTERNAL;
      reply.putText(why.what());
    }
    data_.clear();
  } catch (...) {
    // There is no memory for the text.
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
      throw Refusal(kBadCommand, "data: more than " + std::to_string(kMostWords) +
                                     " words, a hull of " + std::to_string(kMostPoints) +
                                     " points: leave out points");
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
  reply.putText(tandem_version());
}

void Commands::data(Words& words, Reply& reply) {
  words.finish();
  reply.status = static_cast<int>(data_.size());
}

void Commands::share(Words& words, Reply& reply) {
  const int body = words.integer("body");
  const std::optional<Piece> shape = readPieceFromWords(words, takeDoubles());
  if (words.has("object")) {  // it keeps its damping
    const int object = words.integer("object");
    words.finish();
    session_.shareAgain(object, body, shape ? &*shape : nullptr);
    reply.status = object;
    return;
  }
  if (words.has("tool_of")) {
    const std::uint32_t user = words.id("tool_of");
    double at[3]{};
    words.numbersIfThere("at", at, 3);
    words.finish();
    reply.status = session_.shareTool(body, user, at, shape ? &*shape : nullptr);
    return;
  }
  const double damping = words.number("damping", 0.0);
  words.finish();
  reply.status = session_.share(body, damping, shape ? &*shape : nullptr);
}

void Commands::unshare(Words& words, Reply&) {
  const int object = words.integer("object");
  words.finish();
  session_.unshare(object);
}

void Commands::grab(Words& words, Reply&) {
  const int object = words.integer("object");
  double at[3]{};
  const bool has_place = words.numbersIfThere("at", at, 3);
  words.finish();
  session_.grab(object, has_place ? at : nullptr);
}

void Commands::release(Words& words, Reply&) {
  words.finish();
  session_.release();
}

void Commands::grip(Words& words, Reply& reply) {
  words.finish();
  const TandemGrip grip = session_.grip();
  if (grip.object == TANDEM_NO_OBJECT) return;
  reply.put(static_cast<double>(grip.object));
  reply.put(grip.is_fading != 0 ? 1.0 : 0.0);
  for (const double* vector : {grip.at, grip.force, grip.torque}) reply.put(vector, 3);
}

void Commands::obstacle(Words& words, Reply&) {
  const int body = words.integer("body");
  const std::optional<Piece> shape = readPieceFromWords(words, takeDoubles());
  words.finish();
  session_.addObstacle(body, shape ? &*shape : nullptr);
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
    double orientation[4]{}, angular_velocity[3]{};
    const bool turns = words.numbersIfThere("orientation", orientation, 4);
    if (turns) words.numbersIfThere("angular_velocity", angular_velocity, 3);
    words.finish();
    if (turns) check(tandem_device_turn(device, orientation, angular_velocity));
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
  reply.put(reading.reading.force, 3);
}

void Commands::read(Words& words, Reply& reply) {
  words.finish();
  SessionReading all;
  session_.read(all);
  const TandemReading& reading = all.reading;
  reply.put(reading.force, 3);
  reply.put(reading.hip, 3);
  reply.put(reading.hip_velocity, 3);
  reply.put(static_cast<double>(reading.ticks));
  reply.put(static_cast<double>(reading.status));
  reply.put(static_cast<double>(reading.state_hash >> 32U));
  reply.put(static_cast<double>(reading.state_hash & 0xFFFFFFFFU));
  reply.put(static_cast<double>(reading.packets_sent));
  reply.put(static_cast<double>(reading.packets_taken));
  reply.put(all.has_ended ? 1.0 : 0.0);
  reply.put(static_cast<double>(all.objects.size()));
  reply.put(static_cast<double>(all.proxies.size()));
  for (const TandemState& state : all.objects) reply.put(state);
  for (const TandemState& state : all.proxies) reply.put(state);
  for (const int state : all.links) reply.put(static_cast<double>(state));
}

void Commands::contacts(Words& words, Reply& reply) {
  words.finish();
  const std::vector<Session::Contact> contacts = session_.contacts();
  reply.put(static_cast<double>(contacts.size()));
  for (const Session::Contact& contact : contacts) {
    const TandemContact& at = contact.in_tandem;
    reply.put(static_cast<double>(contact.body_a));
    reply.put(static_cast<double>(contact.body_b));
    for (const double* vector : {at.point_a, at.point_b, at.normal}) reply.put(vector, 3);
    reply.put(at.distance);
    reply.put(at.force);
    reply.put(at.friction, 3);
  }
}

void Commands::warnings(Words& words, Reply& reply) {
  words.finish();
  reply.putText(session_.warnings());
}

void Commands::close(Words& words, Reply&) {
  words.finish();
  peers_.clear();
  agreements_.clear();
  session_.close();
}

}  // namespace tandem::pybullet
