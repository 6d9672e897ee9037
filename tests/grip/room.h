#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "tandem/coordination/scheme.h"

#include "coordination/src/wire/wire.h"
#include "coordination/src/wire/wire_state.h"
#include "grip/grip_rig.h"

namespace tandem::test {

/// Passes packets on, and notes their bytes and how often it tells each object.
class MeteredLink final : public Link {
 public:
  explicit MeteredLink(std::unique_ptr<SimulatedLink> link) : link_(std::move(link)) {}

  void send(const StatePacket& packet, double now) noexcept override {
    constexpr std::size_t kIpAndUdp = 28;
    bytes += kIpAndUdp + kHeaderSize + kTagSize +
             computeStateSize(WireProfile::kFloat32, packet.object_count, packet.grip.has_value());
    ++packets;
    for (std::uint32_t i = 0; i < packet.object_count; ++i) {
      const ObjectId id = packet.objects[i].id;
      if (told_at_[id] > 0.0) longest[id] = std::max(longest[id], now - told_at_[id]);
      told_at_[id] = now;
      ++told[id];
    }
    link_->send(packet, now);
  }
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override {
    return link_->receive(from, until);
  }
  void forget() { bytes = packets = 0, told = {}, longest = {}; }

  std::size_t bytes = 0, packets = 0;                 ///< [IP bytes]
  std::array<std::size_t, kMaxSharedObjects> told{};  ///< by object: packets with it
  std::array<double, kMaxSharedObjects> longest{};    ///< by object: time between two of them [s]

 private:
  std::unique_ptr<SimulatedLink> link_;
  std::array<double, kMaxSharedObjects> told_at_{};  ///< [s]
};

struct RoomSettings {
  int objects = 256;
  int users = 16;
  int busy_pairs = 8;   ///< whose first user moves an object
  double budget = 0.0;  ///< [bit/s]; 0: no limit
  Impairments network{.delay = 0.02};
};

/// Cubes in a plane, 0.1 m apart, and pairs of users, at least 0.4 m apart. The first user of a
/// pair holds a cube and moves it along z; the second one's hand is 2 cm below it.
class Room {
 public:
  static constexpr double kStart = 0.5, kAmplitude = 0.02;  // of the strokes [s, m]

  explicit Room(const RoomSettings& wanted) : wanted_(wanted) {
    for (int i = 0; i < wanted.users; ++i) users_.push_back(makeUser(i));
    links_.resize(static_cast<std::size_t>(wanted.users * wanted.users));
    for (int i = 0; i < wanted.users; ++i)
      for (int k = i + 1; k < wanted.users; ++k) connect(i, k);
    for (int i = 0; i < 2 * wanted.busy_pairs; i += 2) user(i).site->grab(held(i));
  }

  /// Calls `look` after each host step.
  void run(
      double seconds, const std::function<void()>& look = [] {}) {
    constexpr int kTicks = 4;
    for (int step = 0; step < std::lround(seconds / (kTicks * kTick)); ++step) {
      for (int tick = 0; tick < kTicks; ++tick, ++ticks_)
        for (auto& one : users_) one->site->tick(now());
      for (auto& one : users_) one->rig.step(kTicks * kTick);
      look();
    }
  }
  [[nodiscard]] double now() const { return static_cast<double>(ticks_) * kTick; }

  /// The cube of a user's pair.
  [[nodiscard]] ObjectId held(int i) const { return static_cast<ObjectId>(i / 2); }
  [[nodiscard]] Site& site(int i) { return *user(i).site; }
  /// The way from one site to another.
  [[nodiscard]] MeteredLink& link(int from, int to) {
    return *links_[static_cast<std::size_t>(from * wanted_.users + to)];
  }
  /// Sent by a site to all others [bit/s].
  [[nodiscard]] double computeTraffic(int from, double seconds) {
    std::size_t bytes = 0;
    for (int to = 0; to < wanted_.users; ++to)
      if (to != from) bytes += link(from, to).bytes;
    return 8.0 * static_cast<double>(bytes) / seconds;
  }
  void forget() {
    for (auto& one : links_)
      if (one) one->forget();
  }

 private:
  struct User {
    explicit User(ScriptedDevice::Path path) : device(std::move(path)) {}
    ~User() { site.reset(); }
    BulletRig rig;
    ScriptedDevice device;
    std::unique_ptr<Site> site;
  };

  [[nodiscard]] User& user(int i) { return *users_[static_cast<std::size_t>(i)]; }
  static PeerId idOf(int i) { return PeerId{static_cast<std::uint32_t>(i) + 1}; }
  /// The place of a cube at the start: those of the pairs have others around them.
  [[nodiscard]] static Vec3 placeOf(ObjectId id) {
    constexpr ObjectId kPairs = 8;
    const ObjectId row = id < kPairs ? 4 + 8 * (id / 4) : (id - kPairs) / 16;
    const ObjectId column = id < kPairs ? 2 + 4 * (id % 4) : (id - kPairs) % 16;
    const double aside = id < kPairs ? 0.0 : 0.05;
    return {0.1 * column + aside, 0.1 * row + aside, 0.0};
  }
  [[nodiscard]] Vec3 startOf(int i) const {
    const bool holds = i % 2 == 0 && i / 2 < wanted_.busy_pairs;
    return placeOf(held(i)) - (holds ? 0.0 : 0.07) * Vec3::UnitZ();
  }

  [[nodiscard]] std::unique_ptr<User> makeUser(int i) const {
    const bool moves = i % 2 == 0 && i / 2 < wanted_.busy_pairs;
    const double rate = 4.0 + 0.2 * i;  // [rad/s]
    auto made = std::make_unique<User>([start = startOf(i), moves, rate](double t) -> Vec3 {
      const double z = kAmplitude * std::sin(rate * std::max(t - kStart, 0.0));
      return start + (moves ? z : 0.0) * Vec3::UnitZ();
    });
    made->site = std::make_unique<Site>(makeSettings(i), made->rig.world, made->device);
    for (int o = 0; o < wanted_.objects; ++o)
      made->site->share(made->rig.addCube(kMass, 0.02, placeOf(static_cast<ObjectId>(o))), 0.5);
    return made;
  }
  /// Each copy is tied to the others as to their mean.
  [[nodiscard]] SiteSettings makeSettings(int i) const {
    SiteSettings settings;
    settings.self = idOf(i);
    settings.peers = wanted_.users;
    settings.scheme = &findScheme("virtual_coupling");
    settings.coordination = {200.0 / (wanted_.users - 1), 30.0 / (wanted_.users - 1)};
    settings.tick_source = TickSource::kCaller;
    settings.host_step = 4 * kTick;
    settings.packet_budget = wanted_.budget;
    settings.passivity.enabled = false;
    return settings;
  }
  void connect(int i, int k) {
    Impairments network = wanted_.network;
    network.seed += static_cast<std::uint64_t>(i * wanted_.users + k);
    auto [one, other] = makeSimulatedLinks(network, 64);
    auto& there = links_[static_cast<std::size_t>(i * wanted_.users + k)];
    auto& back = links_[static_cast<std::size_t>(k * wanted_.users + i)];
    there = std::make_unique<MeteredLink>(std::move(one));
    back = std::make_unique<MeteredLink>(std::move(other));
    user(i).site->connect(idOf(k), *there, startOf(k));
    user(k).site->connect(idOf(i), *back, startOf(i));
  }

  static constexpr double kMass = 1.6;  // of a whole cube [kg]

  RoomSettings wanted_;
  std::vector<std::unique_ptr<MeteredLink>> links_;  ///< by sender and receiver
  std::vector<std::unique_ptr<User>> users_;
  std::uint64_t ticks_ = 0;
};

}  // namespace tandem::test
