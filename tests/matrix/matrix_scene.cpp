#include "matrix/matrix_scene.h"

#include <algorithm>
#include <cmath>

#include "tandem/coordination/passivity_observer.h"
#include "tandem/coordination/scheme.h"

namespace tandem::test {
namespace {

constexpr int kTicksPerHostStep = 4;
constexpr double kHalf = 0.02,
                 kRadius = 0.01;        // half edge of the cube; radius of device and proxies [m]
constexpr double kObjectDamping = 4.0;  // [N s/m]
constexpr double kGap = 5e-3;           ///< distance from the hands to what they will touch [m]
constexpr double kRest = 1.0;           ///< pause before the first stroke, idle at its end [s]
constexpr double kStroke = 1.6;         ///< duration of a stroke, there and back [s]
constexpr double kReach = 0.05;         ///< length of a stroke from the start [m]
constexpr double kLedBack = 3.0;        ///< longest way back of objects after a loss [s]
constexpr double kAfter = 2.0;          ///< time watched after full recovery [s]

/// A hand whose time begins at a moment that is set later.
class LaterHand final : public Hand {
 public:
  LaterHand(std::unique_ptr<Hand> hand, const double& begin)
      : hand_(std::move(hand)), begin_(begin) {}
  [[nodiscard]] Vec3 computeForce(double t, const PointState& handle) const noexcept override {
    return hand_->computeForce(std::max(t - begin_, 0.0), handle);
  }

 private:
  std::unique_ptr<Hand> hand_;
  const double& begin_;
};

std::vector<Waypoint> makeStrokes(const Vec3& start_W, int count) {
  std::vector<Waypoint> way;
  for (int i = 0; i < count; ++i) {
    const double t = kStroke * i;
    way.push_back({t, start_W});
    way.push_back({t + 0.5, start_W + Vec3(kReach, 0, 0)});
    way.push_back({t + 0.8, start_W + Vec3(kReach, 0, 0)});
    way.push_back({t + 1.3, start_W});
  }
  return way;
}

}  // namespace

MatrixScene::MatrixScene(const Condition& condition, std::uint64_t seed)
    : c_(condition), network_(condition, seed) {
  phase_ = Random(seed).uniform(0.0, kStroke);
  users_[1].clock_offset = 1000.0;
  for (std::size_t i = 0; i < 2; ++i) makeUser(i);
}

// Destroys sites before the worlds, devices and links that they use.
MatrixScene::~MatrixScene() {
  for (User& user : users_) user.site.reset();
}

Vec3 MatrixScene::startOf(std::size_t i) const {
  const double touch = kRadius + (c_.task == Task::kMeeting ? 0.0 : kHalf) + kGap;
  return {i == 0 ? -touch : touch, 0, 0};
}

std::unique_ptr<Hand> MatrixScene::makeHand(std::size_t i) const {
  if (c_.hands_shake) {
    // Towards each other, never in step.
    const Vec3 f_W(i == 0 ? 3.0 : -3.0, 0, 0);
    return std::make_unique<LaterHand>(makeSineHand(f_W, i == 0 ? 1.3 : 1.9, 0.0), begin_);
  }
  if (i == 0)
    return std::make_unique<LaterHand>(makeMinimumJerkHand(makeStrokes(startOf(0), 8), 150.0, 3.0),
                                       begin_);
  return makeMinimumJerkHand({{0.0, startOf(1)}}, 60.0, 1.0);
}

void MatrixScene::makeUser(std::size_t i) {
  User& user = users_[i];
  const PeerId self = idOf(i), other = idOf(1 - i);
  SimulatedDeviceSettings device;
  device.start_W = startOf(i);
  device.max_force = kMaxForce;
  if (c_.is_guided) device.guide = Vec3::UnitX();
  user.handle = std::make_unique<SimulatedDevice>(device, makeHand(i));
  user.device = std::make_unique<MeteredDevice>(*user.handle);

  net::PeerSession::Common common;
  common.configuration = makeConfiguration({{"scheme", c_.scheme}, {"object.mass", "0.2"}});
  common.playout.is_on = c_.has_playout;
  std::vector<net::PeerGroup::Peer> peers;
  peers.push_back({other, VirtualNet::addressOf(static_cast<int>(2 - i)), makeKey(0x42)});
  user.mesh = std::make_unique<net::PeerGroup>(self, std::move(peers), common, network_.port(i));
  user.link = std::make_unique<LinkWatch>(
      user.mesh->link(other), users_[1 - i].clock_offset - user.clock_offset,
      [this, i](double sent, double came) {
        User& to = users_[i];
        const double late = came - sent - c_.slowest() - statusOf(i).wait;
        to.report.largest_excess = std::max(to.report.largest_excess, late);
        to.report.last_taken = came - to.clock_offset;
        if (sent - to.clock_offset >= outage_end_ && to.report.first_new < 0.0)
          to.report.first_new = came - to.clock_offset - outage_end_;
      });

  SiteSettings settings;
  settings.self = self;
  settings.tick_source = TickSource::kCaller;
  settings.host_step = kTicksPerHostStep * kPeriod;
  settings.thins_when_idle = c_.thins_when_idle;
  settings.max_slew = c_.max_slew;
  settings.scheme = &findScheme(c_.scheme);
  settings.link_loss.start_live = false;
  settings.link_loss.ramp_in = kRampIn;
  if (c_.is_guided) settings.guide = Vec3::UnitX();
  if (c_.task == Task::kMeeting) {
    settings.contact.stiffness = 2000.0;
    settings.coordination.damping = 10.0;
  }
  user.site = std::make_unique<Site>(settings, user.rig.world, *user.device);
  if (c_.task != Task::kMeeting)
    user.site->share(user.rig.addCube(0.2, kHalf),
                     c_.task == Task::kCooperation ? kObjectDamping : 0.0);
  user.site->connect(other, *user.link, startOf(1 - i));
}

CellReport MatrixScene::run() {
  while (now_ < end_ && (now_ < kPatience || report_.joined >= 0.0)) {
    step();
    if (report_.joined < 0.0 && areLive()) {
      report_.joined = now_;
      planFrom(now_);
    }
  }
  for (std::size_t i = 0; i < 2; ++i) {
    User& user = users_[i];
    SiteReport& report = user.report;
    report.phase = statusOf(i).phase;
    report.status = user.site->status();
    report.counters = user.site->counters();
    report.overdrawn = user.site->passivity().overdrawn();
    if (report.last_coupled >= 0.0) report.last_coupled = now_ - report.last_coupled;
    report.last_taken = now_ - report.last_taken;
    report_.sites[i] = report;
  }
  report_.hash = users_[0].site->stateHash() ^ users_[1].site->stateHash() * 0x9e3779b97f4a7c15u;
  return report_;
}

void MatrixScene::planFrom(double now) {
  begin_ = now + kRest;
  const double cut_from = begin_ + 0.3 + phase_;
  outage_end_ = cut_from + c_.outage;
  network_.cutFrom(cut_from, outage_end_);
  end_ = outage_end_ + 2.0 * c_.slowest() + kGrace + kRampIn + kAfter;
  if (c_.outage > 0.2) end_ += kLedBack;
}

void MatrixScene::step() {
  now_ = static_cast<double>(ticks_) * kPeriod;
  network_.deliverUntil(now_, [&](std::size_t to, ByteSpan datagram) {
    users_[to].mesh->receive(datagram, VirtualNet::addressOf(static_cast<int>(2 - to)),
                             now_ + users_[to].clock_offset);
  });
  for (User& user : users_) user.mesh->advance(now_ + user.clock_offset);
  for (std::size_t i = 0; i < 2; ++i) tickUser(i);
  report_.least_energy =
      std::min(report_.least_energy, users_[0].device->putIn() + users_[1].device->putIn());
  if (++ticks_ % kTicksPerHostStep != 0) return;
  for (User& user : users_) user.rig.step(kTicksPerHostStep * kPeriod);
}

void MatrixScene::tickUser(std::size_t i) {
  User& user = users_[i];
  SiteReport& report = user.report;
  user.site->tick(now_ + user.clock_offset);
  const Vec3& force_W = user.site->force();
  report.largest_force = std::max(report.largest_force, force_W.norm());
  report.largest_rise = std::max(report.largest_rise, force_W.norm() - user.force_W.norm());
  report.is_finite &= force_W.allFinite() && isFinite(user.site->hip());
  if (user.site->objectCount() > 0) report.is_finite &= isFinite(user.site->object(0));
  user.force_W = force_W;
  watchLink(user);
}

void MatrixScene::watchLink(User& user) {
  const LinkState state = user.site->linkState(0);
  const bool is_live = state == LinkState::kLive;
  const bool is_coupled = is_live || state == LinkState::kRejoining;
  SiteReport& report = user.report;
  if (is_coupled) report.last_coupled = now_;
  if (now_ < outage_end_ || report.first_new < 0.0) return;
  const double since = now_ - outage_end_;
  if (is_live && report.live_again < 0.0) report.live_again = since;
  if (is_coupled && report.recovered < 0.0) report.recovered = since;
}

PeerStatus MatrixScene::statusOf(std::size_t i) const {
  return users_[i].mesh->status(idOf(1 - i), now_ + users_[i].clock_offset);
}

bool MatrixScene::areLive() const {
  return statusOf(0).phase == PeerPhase::kLive && statusOf(1).phase == PeerPhase::kLive;
}

}  // namespace tandem::test
