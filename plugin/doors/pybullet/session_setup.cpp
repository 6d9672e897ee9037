#include <algorithm>

#include "refusal.h"
#include "session.h"

namespace tandem::pybullet {
namespace {

[[noreturn]] void refuse(int body, const std::string& why) {
  throw Refusal(kPyBulletSays, "body " + std::to_string(body) + ": " + why);
}

}  // namespace

Session::Session(const B3Functions& functions, b3::Client client) : engine_(functions, client) {}

Session::~Session() { sayFarewell(1); }

void Session::requireNoSite() const {
  if (site_) throw Refusal(kWrongOrder, "there is a site already: `close` first");
}

void Session::requireOpen() const {
  if (!site_) throw Refusal(kWrongOrder, "there is no site yet: `device`, then `site`");
}

void Session::requireSite() const {
  requireOpen();
  if (!ended_.empty()) throw Refusal(kWrongOrder, ended_ + "; `close` and begin again");
}

void Session::requireFree(int body) const {
  const auto is_it = [&](const auto& held) { return held.body.number() == body; };
  if (std::any_of(moving_.begin(), moving_.end(), is_it) ||
      std::any_of(standing_.begin(), standing_.end(), is_it)) {
    refuse(body, "is attached already");
  }
}

void Session::takeDevice(DeviceHandle device, bool is_moved) {
  requireNoSite();
  device_ = std::move(device);
  device_is_moved_ = is_moved;
}

void Session::openSite(const TandemSiteSettings& settings) {
  requireNoSite();
  if (!device_) throw Refusal(kWrongOrder, "a site needs a device: `device` first");
  const EngineParameters parameters = askParameters();
  TandemWorld* world = nullptr;
  check(tandem_world_create(&world));
  WorldHandle own_world(world);
  check(tandem_world_set_gravity(world, parameters.gravity));
  TandemSite* site = nullptr;
  check(tandem_site_create(&settings, world, device_.get(), &site));
  site_.reset(site);
  world_ = std::move(own_world);
  peers_ = settings.peers;
  proxy_mass_ = settings.proxy_mass;
  parameters_ = parameters;
}

EngineParameters Session::askParameters() const {
  const std::optional<EngineParameters> asked = engine_.readParameters();
  if (!asked) throw Refusal(kPyBulletSays, "PyBullet does not tell its time step");
  return *asked;
}

void Session::addObstacle(int body, const Piece* shape) {
  requireSite();
  requireFree(body);
  BorrowedBody borrowed(engine_, body);
  if (borrowed.before().mass > 0.0) {
    refuse(body, "moves; an obstacle is static (fixed base or mass 0)");
  }
  if (borrowed.before().links > 0) refuse(body, "has links, of which Tandem would not know");
  Standing standing{borrowed, findPieces(borrowed, shape), {}, {}};
  if (!engine_.readState(body, standing.pose)) refuse(body, "is not there");
  try {
    for (Piece& piece : standing.pieces) {
      standing.ids.push_back(addGuest(borrowed, piece, computePieceState(standing.pose, piece)));
    }
  } catch (const Refusal&) {
    for (const TandemBody id : standing.ids) (void)tandem_world_remove_body(world_.get(), id);
    throw;
  }
  standing.body.borrow(engine_, 0.0);
  for (const Moving& other : moving_) stopContact(body, other.body.number());
  standing_.push_back(std::move(standing));
}

void Session::showProxy(int remote, int body) {
  requireSite();
  requireFree(body);
  if (remote < 0 || remote >= static_cast<int>(proxies_.size())) {
    throw Refusal(kBadCommand, "remote=" + std::to_string(remote) + ": no such remote");
  }
  const TandemBody id = proxies_[static_cast<std::size_t>(remote)];
  if (id == TANDEM_NO_BODY) {
    throw Refusal(kWrongOrder, "the site's scheme has no proxy that could be shown");
  }
  if (std::any_of(moving_.begin(), moving_.end(), [&](const Moving& m) { return m.id == id; })) {
    throw Refusal(kWrongOrder, "the proxy of this remote is shown already");
  }
  BorrowedBody borrowed(engine_, body);
  if (borrowed.before().links > 0 || !(borrowed.before().mass > 0.0)) {
    refuse(body, "must move and have no links to show a proxy");
  }
  TandemState state{};
  check(tandem_world_get_states(world_.get(), 1, &id, &state));
  borrowed.borrow(engine_, proxy_mass_ / borrowed.before().mass, true);
  engine_.writeState(body, state);
  stopContactWithAll(body);
  addMoving(std::move(borrowed), id, state, kProxy);
}

void Session::close() {
  constexpr int kFarewells = 10;
  for (Moving& one : moving_) one.body.giveBack(engine_);
  for (Standing& one : standing_) one.body.giveBack(engine_);
  // A body that was removed since the last step may have left its number to another.
  for (const auto& [a, b] : without_contact_) engine_.setCollides(a, b, true);
  sayFarewell(kFarewells);
  site_.reset();
  world_.reset();
  device_.reset();
  links_.clear();
  mesh_.reset();
  moving_.clear(), standing_.clear(), proxies_.clear(), mesh_peers_.clear();
  without_contact_.clear();
  ids_.clear(), now_.clear(), told_.clear();
  warnings_.clear();
  tools_.clear(), lost_.clear();
  ended_.clear();
  is_between_ = has_warned_of_step_ = has_ever_lost_ = false;
}

}  // namespace tandem::pybullet
