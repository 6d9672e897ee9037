#include <algorithm>

#include "refusal.h"
#include "session.h"

// Bodies that come, change and go while a site is open.

namespace tandem::pybullet {
namespace {

using Presence = BorrowedBody::Presence;

[[noreturn]] void refuseBody(int body, const std::string& why) {
  throw Refusal(kPyBulletSays, "body " + std::to_string(body) + ": " + why);
}

void checkShareableFacts(int body, const BodyFacts& facts) {
  if (facts.links > 0) {
    refuseBody(body, "has " + std::to_string(facts.links) +
                         " links besides its base; only a body without joints can be shared");
  }
  if (!(facts.mass > 0.0)) {
    refuseBody(body,
               "is static (fixed base or mass 0); share a moving body, or make it an obstacle");
  }
}

std::string tellWhy(int body, const BodyFacts& facts, Presence presence) {
  const std::string name = "body " + std::to_string(body);
  if (presence == Presence::kPinned) return name + " was made static";
  if (presence == Presence::kFreed) return name + " was given a mass";
  std::string why = name + " was removed from PyBullet while attached";
  if (presence != Presence::kUnmarked) return why;
  why += " and another has its number";
  // PyBullet tells too little of these to know them again.
  if (!facts.is_multibody) {
    why +=
        ", or its friction and both dampings were set at once: with maximal coordinates, leave "
        "one of them for the next step";
  }
  return why;
}

}  // namespace

std::vector<Piece> Session::findPieces(const BorrowedBody& body, const Piece* shape) const {
  if (shape) return {*shape};
  return readPieces(engine_, body.number(), body.before());
}

void Session::describeGuest(const BorrowedBody& body, const TandemState& state,
                            TandemBodySettings& settings) {
  const BodyFacts& facts = body.before();
  settings.mass = facts.mass;
  std::copy_n(facts.inertia, 3, settings.inertia);
  settings.friction = facts.friction;
  settings.restitution = facts.restitution;
  settings.start = state;
}

TandemBody Session::addGuest(const BorrowedBody& body, Piece& piece, const TandemState& state) {
  TandemBodySettings& settings = piece.settings;
  settings.points = piece.points.data();
  settings.point_count = piece.points.size() / 3;
  describeGuest(body, state, settings);
  TandemBody id = TANDEM_NO_BODY;
  check(tandem_world_add_body(world_.get(), &settings, &id));
  finishGuest(id, body.before());
  return id;
}

/// A guest of several pieces, or of one beside its centre of mass.
TandemBody Session::addGuest(const BorrowedBody& body, const std::vector<Piece>& pieces,
                             const TandemState& state) {
  TandemBodySettings settings = tandem_default_body_settings();
  describeGuest(body, state, settings);
  std::vector<TandemShapePart> parts;
  parts.reserve(pieces.size());
  for (const Piece& piece : pieces) {
    TandemShapePart& part = parts.emplace_back();
    part.shape = piece.settings.shape;
    std::copy_n(piece.settings.size, 3, part.size);
    part.points = piece.points.data();
    part.point_count = piece.points.size() / 3;
    std::copy_n(piece.position, 3, part.position);
    std::copy_n(piece.orientation, 4, part.orientation);
  }
  TandemBody id = TANDEM_NO_BODY;
  check(tandem_world_add_compound(world_.get(), &settings, parts.size(), parts.data(), &id));
  finishGuest(id, body.before());
  return id;
}

void Session::finishGuest(TandemBody id, const BodyFacts& facts) {
  if (facts.rolling_friction > 0.0 || facts.spinning_friction > 0.0) tellDynamics(id, facts);
}

void Session::tellDynamics(TandemBody id, const BodyFacts& facts) {
  TandemDynamics dynamics{facts.mass,
                          {},
                          facts.friction,
                          facts.restitution,
                          facts.rolling_friction,
                          facts.spinning_friction};
  std::copy_n(facts.inertia, 3, dynamics.inertia);
  check(tandem_world_set_dynamics(world_.get(), id, &dynamics));
}

void Session::addMoving(BorrowedBody body, TandemBody id, const TandemState& state, int object) {
  moving_.push_back({std::move(body), id, state, object});
  ids_.push_back(id);
  now_.resize(ids_.size());
  told_.resize(ids_.size());
}

/// Makes a guest for a body, and calls `share` with it for the number of the object.
template <typename ShareGuest>
int Session::shareGuest(int body, double mass_share, const Piece* shape, ShareGuest share) {
  requireSite();
  requireFree(body);
  BorrowedBody borrowed(engine_, body);
  checkShareableFacts(body, borrowed.before());
  std::vector<Piece> pieces = findPieces(borrowed, shape);
  TandemState state{};
  if (!engine_.readState(body, state)) refuseBody(body, "is not there");
  const bool is_plain = pieces.size() == 1 && pieces[0].isCentred();
  const TandemBody id =
      is_plain ? addGuest(borrowed, pieces[0], state) : addGuest(borrowed, pieces, state);
  std::uint32_t object = 0;
  if (const TandemResult result = share(id, object); result != TANDEM_OK) {
    const Refusal why(-static_cast<int>(result),
                      "body " + std::to_string(body) + ": " + tandem_last_error());
    (void)tandem_world_remove_body(world_.get(), id);
    throw why;
  }
  borrowed.borrow(engine_, mass_share);
  stopContactWithAll(body);
  addMoving(std::move(borrowed), id, state, static_cast<int>(object));
  return static_cast<int>(object);
}

int Session::share(int body, double damping, const Piece* shape) {
  return shareGuest(body, 1.0 / peers_, shape, [&](TandemBody id, std::uint32_t& object) {
    return tandem_site_share(site_.get(), id, damping, &object);
  });
}

int Session::shareTool(int body, std::uint32_t user, const double at[3], const Piece* shape) {
  const int object = shareGuest(body, 1.0, shape, [&](TandemBody id, std::uint32_t& number) {
    return tandem_site_share_tool(site_.get(), id, user, at, &number);
  });
  tools_.push_back(object);
  return object;
}

void Session::shareAgain(int object, int body, const Piece* shape) {
  requireSite();
  if (findObject(object) < moving_.size()) {
    throw Refusal(kWrongOrder, "object " + std::to_string(object) +
                                   " has a body; `unshare` it first, or remove that");
  }
  const bool is_tool = std::find(tools_.begin(), tools_.end(), object) != tools_.end();
  shareGuest(body, is_tool ? 1.0 : 1.0 / peers_, shape, [&](TandemBody id, std::uint32_t& number) {
    number = static_cast<std::uint32_t>(object);
    return tandem_site_share_again(site_.get(), number, id);
  });
  lost_.erase(std::remove(lost_.begin(), lost_.end(), object), lost_.end());
}

void Session::unshare(int object) {
  requireSite();
  if (const std::size_t place = findObject(object); place < moving_.size()) {
    return release(place, true);
  }
  check(tandem_site_unshare(site_.get(), static_cast<std::uint32_t>(object)));
  lost_.erase(std::remove(lost_.begin(), lost_.end(), object), lost_.end());
}

void Session::grab(int object, const double* at) {
  requireSite();
  check(tandem_site_grab(site_.get(), static_cast<std::uint32_t>(object), at));
}

void Session::release() {
  requireSite();
  check(tandem_site_release(site_.get()));
}

TandemGrip Session::grip() {
  requireSite();
  TandemGrip grip{};
  check(tandem_site_read_grip(site_.get(), &grip));
  return grip;
}

/// Place of an object's body in `moving_`, or past its end.
std::size_t Session::findObject(int object) const {
  const auto is_it = [object](const Moving& one) { return one.object == object; };
  return static_cast<std::size_t>(std::find_if(moving_.begin(), moving_.end(), is_it) -
                                  moving_.begin());
}

/// Ends the attachment of one body: PyBullet has it again, if it is there.
void Session::release(std::size_t place, bool is_there) {
  Moving& one = moving_[place];
  if (one.object != kProxy) {
    check(tandem_site_unshare(site_.get(), static_cast<std::uint32_t>(one.object)));
    check(tandem_world_remove_body(world_.get(), one.id));
  }
  if (is_there) one.body.giveBack(engine_);
  restoreContact(one.body.number());
  const auto at = static_cast<std::ptrdiff_t>(place);
  moving_.erase(moving_.begin() + at);
  ids_.erase(ids_.begin() + at);
  now_.erase(now_.begin() + at);
  told_.erase(told_.begin() + at);
}

void Session::lose(std::size_t place, Presence presence) {
  const int object = moving_[place].object;
  const BorrowedBody& body = moving_[place].body;
  const std::string why = tellWhy(body.number(), body.before(), presence);
  try {
    release(place, presence == Presence::kPinned);
  } catch (const Refusal& refused) {  // with a guide no object leaves alone
    throw Refusal(refused.status(), why + "; " + refused.what());
  }
  if (object == kProxy) return warn(why + ": it shows no proxy any more");
  lost_.push_back(object);
  has_ever_lost_ = true;
  warn(why);
}

void Session::loseObstacle(std::size_t place, Presence presence) {
  Standing& one = standing_[place];
  warn(tellWhy(one.body.number(), one.body.before(), presence) + ": it is no obstacle any more");
  for (const TandemBody id : one.ids) check(tandem_world_remove_body(world_.get(), id));
  if (presence == Presence::kFreed) one.body.giveBack(engine_);
  restoreContact(one.body.number());
  standing_.erase(standing_.begin() + static_cast<std::ptrdiff_t>(place));
}

/// Looks at a moving body and follows what the user did to it. False if it is attached no more.
bool Session::keep(std::size_t place) {
  Moving& one = moving_[place];
  const Presence presence = look(one.body);
  if (presence == Presence::kChanged && one.object != kProxy) {
    tellDynamics(one.id, one.body.before());
  }
  if (presence == Presence::kSame || presence == Presence::kChanged) return true;
  lose(place, presence);
  return false;
}

bool Session::keepObstacle(std::size_t place) {
  Standing& one = standing_[place];
  const Presence presence = look(one.body);
  if (presence == Presence::kChanged) {
    for (const TandemBody id : one.ids) tellDynamics(id, one.body.before());
  }
  if (presence == Presence::kSame || presence == Presence::kChanged) return true;
  loseObstacle(place, presence);
  return false;
}

void Session::stopContact(int body_a, int body_b) {
  engine_.setCollides(body_a, body_b, false);
  without_contact_.emplace_back(body_a, body_b);
}

// Guests collide in Tandem's world; contact in PyBullet, too, would count twice.
void Session::stopContactWithAll(int body) {
  for (const Standing& other : standing_) stopContact(body, other.body.number());
  for (const Moving& other : moving_) stopContact(body, other.body.number());
}

/// PyBullet's own contact of a body that is attached no more acts again. Numbers of removed bodies
/// are given to others, so the filter must not stay.
void Session::restoreContact(int body) {
  for (const auto& [a, b] : without_contact_) {
    if (a == body || b == body) engine_.setCollides(a, b, true);
  }
  const auto is_of_it = [body](const std::pair<int, int>& pair) {
    return pair.first == body || pair.second == body;
  };
  without_contact_.erase(std::remove_if(without_contact_.begin(), without_contact_.end(), is_of_it),
                         without_contact_.end());
}

}  // namespace tandem::pybullet
