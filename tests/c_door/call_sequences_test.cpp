// Random calls in random order. The door never crashes, refuses calls as a simple model of its
// handles predicts, and gives a message.

#include <algorithm>
#include <string>
#include <vector>

#include "c_door/c_door_rig.h"
#include "support/random.h"

namespace tandem {
namespace {

using namespace test;

/// A handle in the model.
template <typename Handle>
struct Known {
  Handle* handle = nullptr;
  int users = 0;
  bool is_alive = true;
};

class Caller {
 public:
  explicit Caller(std::uint64_t seed) : random_(seed) {}
  ~Caller() {
    for (SiteModel& site : sites_) {
      if (site.known.is_alive) ok(tandem_site_destroy(site.known.handle));
    }
    destroyAll(worlds_, tandem_world_destroy);
    destroyAll(devices_, tandem_device_destroy);
    destroyAll(links_, tandem_link_destroy);
  }

  void call() {
    switch (random_.below(16)) {
      case 0:
        return createWorld();
      case 1:
        return createDevice();
      case 2:
        return createLink();
      case 3:
        return createSite();
      case 4:
        return connect();
      case 5:
        return addBody();
      case 6:
        return share();
      case 7:
        return destroy(worlds_, tandem_world_destroy);
      case 8:
        return destroy(devices_, tandem_device_destroy);
      case 9:
        return destroy(links_, tandem_link_destroy);
      case 10:
        return destroySite();
      case 11:
        return removeBody();
      case 12:
        return guests();
      case 13:
        return move();
      case 14:
        return packets();
      default:
        return step();
    }
  }

  int refused = 0, done = 0;

 private:
  struct BodyModel {
    TandemBody body;
    std::size_t world;
    bool is_there = true;
    int site = -1;  ///< index of the site that shares it
  };
  struct SiteModel {
    Known<TandemSite> known;
    std::size_t world = 0, device = 0;
    std::vector<std::size_t> links;
    std::vector<std::uint32_t> peers;
  };

  /// Picks one of all handles ever made, dead ones too.
  template <typename Model>
  std::size_t pick(const std::vector<Model>& models) {
    return static_cast<std::size_t>(random_.below(static_cast<int>(models.size())));
  }

  void expect(bool is_fine, TandemResult result, const char* what) {
    EXPECT_EQ(result == TANDEM_OK, is_fine)
        << what << ": " << tandem_result_name(result) << " " << tandem_last_error();
    EXPECT_NE(result, TANDEM_INTERNAL) << what << ": " << tandem_last_error();
    ++(result == TANDEM_OK ? done : refused);
    if (result != TANDEM_OK) {
      EXPECT_STRNE(tandem_last_error(), "") << what;
    }
  }

  void createWorld() {
    if (worlds_.size() >= kMost) return;
    Known<TandemWorld> world;
    expect(true, tandem_world_create(&world.handle), "create world");
    worlds_.push_back(world);
  }
  void createDevice() {
    if (devices_.size() >= kMost) return;
    const double start[3] = {random_.uniform(-1.0, 1.0), 0.0, 0.0};
    Known<TandemDevice> device;
    expect(true, tandem_device_create_moved(start, kAnyForce, &device.handle), "create device");
    devices_.push_back(device);
  }
  void createLink() {
    if (links_.size() >= kMost) return;
    Known<TandemLink> link;
    expect(true, tandem_link_create_manual(&link.handle), "create link");
    links_.push_back(link);
  }
  void createSite() {
    if (worlds_.empty() || devices_.empty() || sites_.size() >= kMost) return;
    SiteModel site;
    site.world = pick(worlds_), site.device = pick(devices_);
    Known<TandemWorld>& world = worlds_[site.world];
    Known<TandemDevice>& device = devices_[site.device];
    TandemSiteSettings settings = tandem_default_site_settings();
    const bool is_good = random_.below(4) != 0;
    if (!is_good) settings.contact.damping = -1.0;
    const bool is_fine =
        is_good && world.is_alive && world.users == 0 && device.is_alive && device.users == 0;
    const TandemResult result =
        tandem_site_create(&settings, world.handle, device.handle, &site.known.handle);
    expect(is_fine, result, "create site");
    if (result != TANDEM_OK) return;
    ++world.users, ++device.users;
    sites_.push_back(site);
  }
  void connect() {
    if (sites_.empty() || links_.empty()) return;
    SiteModel& site = sites_[pick(sites_)];
    const std::size_t link = pick(links_);
    const auto peer = static_cast<std::uint32_t>(random_.below(5));
    const bool is_new = std::find(site.peers.begin(), site.peers.end(), peer) == site.peers.end();
    const bool is_fine = site.known.is_alive && links_[link].is_alive && links_[link].users == 0 &&
                         peer > 1 && is_new;
    const TandemResult result =
        tandem_site_connect(site.known.handle, peer, links_[link].handle, kFarAway, nullptr);
    expect(is_fine, result, "connect");
    if (result != TANDEM_OK) return;
    ++links_[link].users;
    site.links.push_back(link);
    site.peers.push_back(peer);
  }
  void addBody() {
    if (worlds_.empty()) return;
    const std::size_t world = pick(worlds_);
    TandemBodySettings settings = tandem_default_body_settings();
    settings.shape = static_cast<TandemShapeKind>(random_.below(4));
    const Vec3 p = random_.inCube(1.0);
    for (int i = 0; i < 3; ++i) settings.start.position[i] = p[i];
    TandemBody body = TANDEM_NO_BODY;
    const TandemResult result = tandem_world_add_body(worlds_[world].handle, &settings, &body);
    expect(worlds_[world].is_alive, result, "add body");
    if (result == TANDEM_OK) bodies_.push_back({body, world, true, -1});
  }
  void share() {
    if (sites_.empty() || bodies_.empty()) return;
    const std::size_t place = pick(sites_);
    SiteModel& site = sites_[place];
    BodyModel& body = bodies_[pick(bodies_)];
    // The same number may be another body in another world.
    if (body.world != site.world) return;
    const bool is_fine = site.known.is_alive && body.is_there && body.site < 0;
    const TandemResult result = tandem_site_share(site.known.handle, body.body, 0.0, nullptr);
    expect(is_fine, result, "share");
    if (result == TANDEM_OK) body.site = static_cast<int>(place);
  }
  void removeBody() {
    if (bodies_.empty()) return;
    BodyModel& body = bodies_[pick(bodies_)];
    const bool is_fine = worlds_[body.world].is_alive && body.is_there && body.site < 0;
    const TandemResult result = tandem_world_remove_body(worlds_[body.world].handle, body.body);
    expect(is_fine, result, "remove body");
    if (result == TANDEM_OK) body.is_there = false;
  }
  template <typename Handle>
  void destroy(std::vector<Known<Handle>>& all, TandemResult (*destroyer)(Handle*)) {
    if (all.empty() || random_.below(4) != 0) return;
    Known<Handle>& known = all[pick(all)];
    const TandemResult result = destroyer(known.handle);
    expect(known.is_alive && known.users == 0, result, "destroy");
    if (result == TANDEM_OK) known.is_alive = false;
  }
  void destroySite() {
    if (sites_.empty() || random_.below(3) != 0) return;
    const std::size_t place = pick(sites_);
    SiteModel& site = sites_[place];
    const TandemResult result = tandem_site_destroy(site.known.handle);
    expect(site.known.is_alive, result, "destroy site");
    if (result != TANDEM_OK) return;
    site.known.is_alive = false;
    --worlds_[site.world].users, --devices_[site.device].users;
    for (const std::size_t link : site.links) --links_[link].users;
    for (BodyModel& body : bodies_)
      if (body.site == static_cast<int>(place)) body.site = -1;
  }
  /// Steps all guests of a world; the host may act in between.
  void guests() {
    if (worlds_.empty()) return;
    const std::size_t world = pick(worlds_);
    std::vector<TandemBody> bodies;
    for (const BodyModel& body : bodies_)
      if (body.world == world && body.is_there) bodies.push_back(body.body);
    std::vector<TandemState> now(bodies.size());
    TandemWorld* handle = worlds_[world].handle;
    const bool is_alive = worlds_[world].is_alive;
    expect(is_alive, tandem_world_get_states(handle, bodies.size(), bodies.data(), now.data()),
           "get states");
    if (!is_alive) std::fill(now.begin(), now.end(), makeState(Vec3::Zero()));
    for (TandemState& state : now)
      if (random_.below(3) == 0) state.velocity[1] += random_.uniform(-1.0, 1.0);
    const double dt = random_.below(5) == 0 ? 0.0 : random_.logUniform(1e-3, 0.02);
    const TandemResult begun = tandem_world_begin_step(handle, dt, nullptr, bodies.size(),
                                                       bodies.data(), now.data(), now.data());
    expect(is_alive && dt > 0.0, begun, "begin step");
    for (TandemState& state : now)
      for (int i = 0; i < 3; ++i) state.position[i] += dt * state.velocity[i];
    expect(begun == TANDEM_OK,
           tandem_world_end_step(handle, bodies.size(), bodies.data(), now.data(), now.data()),
           "end step");
  }
  void move() {
    if (devices_.empty()) return;
    const Known<TandemDevice>& device = devices_[pick(devices_)];
    const Vec3 p = random_.inCube(1.0);
    const double position[3] = {p.x(), p.y(), random_.below(8) == 0 ? std::nan("") : p.z()};
    expect(device.is_alive && !std::isnan(position[2]),
           tandem_device_move(device.handle, position, kNothing), "move");
  }
  void packets() {
    if (links_.empty()) return;
    const Known<TandemLink>& link = links_[pick(links_)];
    TandemPacket packet{};
    int there = 0;
    packet.sender = static_cast<std::uint32_t>(random_.below(5));
    packet.sequence = static_cast<std::uint64_t>(random_.below(1000));
    packet.energy_granted = random_.uniform(-1.0, 1.0);
    packet.energy_holdings = random_.uniform(-1.0, 1.0);
    packet.object_count = static_cast<std::size_t>(random_.below(4));
    for (TandemState& object : packet.objects) object = makeState(random_.inCube(1.0));
    if (random_.below(8) == 0) packet.objects[0].velocity[0] = std::nan("");
    expect(link.is_alive, tandem_link_push(link.handle, &packet), "push");
    expect(link.is_alive, tandem_link_pop(link.handle, &packet, &there), "pop");
  }
  void step() {
    if (worlds_.empty()) return;
    const Known<TandemWorld>& world = worlds_[pick(worlds_)];
    const double dt = random_.below(8) == 0 ? -1.0 : random_.logUniform(1e-3, 0.02);
    expect(world.is_alive && dt >= 0.0, tandem_world_step(world.handle, dt, 0, 0.0), "step");
  }

  template <typename Handle>
  static void destroyAll(const std::vector<Known<Handle>>& all,
                         TandemResult (*destroyer)(Handle*)) {
    for (const Known<Handle>& known : all) {
      if (known.is_alive) ok(destroyer(known.handle));
    }
  }

  static constexpr std::size_t kMost =
      60;  ///< handles of a kind; fewer than the door remembers as gone

  Random random_;
  std::vector<Known<TandemWorld>> worlds_;
  std::vector<Known<TandemDevice>> devices_;
  std::vector<Known<TandemLink>> links_;
  std::vector<SiteModel> sites_;
  std::vector<BodyModel> bodies_;
};

class CallSequence : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(CallSequence, IsAsTheModelSays) {
  SCOPED_TRACE("seed " + std::to_string(GetParam()));
  Caller caller(GetParam());
  for (int i = 0; i < 1000 && !HasFailure(); ++i) caller.call();
  EXPECT_GT(caller.done, 100);
  EXPECT_GT(caller.refused, 50);
}
// Each seed makes 10,000 calls.
INSTANTIATE_TEST_SUITE_P(Seeds, CallSequence, ::testing::Range<std::uint64_t>(1, 11));

}  // namespace
}  // namespace tandem
