#include "site/press.h"

#include <algorithm>

namespace tandem {
namespace {

constexpr std::size_t kMostContacts = 1024;

/// Contacts of one face: the cosine of the angle between their normals.
constexpr double kSameFace = 1.0 - 1e-9;

/// Strangers are looked for as far as they come in this many host steps.
constexpr double kStepsAhead = 1.5;

bool isMoving(const RigidState& state) noexcept {
  return state.v_W != Vec3::Zero() || state.w_W != Vec3::Zero();
}

}  // namespace

void Press::makeRoom() {
  const auto count = static_cast<std::size_t>(island_.bodyCount());
  pressed_.resize(count);
  held_.resize(count);
  led_.resize(count);
  states_.resize(count);
  contacts_.reserve(kMostContacts);
}

void Press::look(double dt) {
  is_any_pressed_ = false;
  std::fill(pressed_.begin(), pressed_.end(), char{0});
  bodies_.forEachPresent([&](const SiteBody& body) {
    const bool is_pushed = !body.step.reaction.isZero() || body.step.is_supported;
    const bool is_calm = body.bullet->isParked() && !body.step.was_near_awake;
    if (!is_pushed && (is_calm || !surroundings_.isStrangerNear(body, kStepsAhead * dt))) return;
    pressed_[static_cast<std::size_t>(body.index)] = 1;
    is_any_pressed_ = true;
  });
}

void Press::findContacts(double step_end) noexcept {
  contacts_.clear();
  if (!is_any_pressed_) return;
  const std::vector<RigidState>* kept = timeline_.findStates(step_end);
  for (std::size_t b = 0; b < states_.size(); ++b) {
    const auto body = static_cast<BodyIndex>(b);
    states_[b] = kept ? (*kept)[b] : island_.state(body);
    led_[b] = island_.body(body).motion == Motion::kPrescribed && isMoving(states_[b]);
  }
  bodies_.forEach(
      [&](const SiteBody& body) { states_[static_cast<std::size_t>(body.index)] = body.step.end; });
  surroundings_.contactFinder().find(states_, contacts_);
  spread();
}

/// Bodies that hold up a pressed one are pressed, too.
void Press::spread() noexcept {
  for (bool is_new = true; is_new;) {
    is_new = false;
    for (const RigidContact& contact : contacts_) {
      if (contact.b == kStanding || isPressed(contact.a) == isPressed(contact.b)) continue;
      const BodyIndex next = isPressed(contact.a) ? contact.b : contact.a;
      pressed_[static_cast<std::size_t>(next)] = 1;
      is_new = true;
    }
  }
}

void Press::show(double dt) {
  rows_.clear();
  if (contacts_.empty()) return;
  for (std::size_t b = 0; b < held_.size(); ++b) held_[b] = {nullptr, nullptr, led_[b] != 0};
  bodies_.forEachPresent([&](SiteBody& body) {
    const HapticBody* rigid = body.bullet->asRigid();
    HostChange* const change = rigid ? &body.step.shift : nullptr;
    held_[static_cast<std::size_t>(body.index)] = {rigid, change};
  });
  const auto held = [&](BodyIndex body) {
    return body == kStanding ? SupportBody{} : held_[static_cast<std::size_t>(body)];
  };
  for (std::size_t i = 0, next = 0; i < contacts_.size(); i = next) {
    const RigidContact& first = contacts_[i];
    const auto is_same_pair = [&](const RigidContact& other) {
      return other.a == first.a && other.b == first.b && other.n_W.dot(first.n_W) > kSameFace;
    };
    for (next = i + 1; next < contacts_.size() && is_same_pair(contacts_[next]);) ++next;
    if (!isPressed(first.a) && !isPressed(first.b)) continue;
    rows_.addFace(&first, next - i, held(first.a), held(first.b), dt);
  }
}

}  // namespace tandem
