#include <stdexcept>
#include <string>

#include "site/site_impl.h"

namespace tandem {
namespace {

/// Bound of a grip's place in packets [m].
constexpr double kFarthestPlace = 1e3;

enum class Refusal { kNone, kLeftToBullet, kHoldsOther };

}  // namespace

void Site::Impl::checkPlace(const Vec3& at_B) {
  if (!(at_B.cwiseAbs().maxCoeff() <= kFarthestPlace && at_B.allFinite()))
    throw std::invalid_argument("the place of a grip must be finite and within 1000 m");
}

void Site::Impl::checkCanHold() const {
  if (!grips.canHold())
    throw Error(
        "a hand holds objects only with the island and hand-off, and without a guide; leave guide, "
        "contact_model and injection at their defaults");
}

void Site::Impl::grab(ObjectId id, const std::optional<Vec3>& at_B) {
  if (at_B) checkPlace(*at_B);
  checkCanHold();
  const SharedObject& object = findObject(id);
  if (object.tool_of && *object.tool_of != settings.self)
    throw Error("object " + std::to_string(id) + " is the tool of user " +
                std::to_string(static_cast<std::uint32_t>(*object.tool_of)) +
                "; a hand holds objects and its own tool");
  if (!object.rigid)
    throw Error("object " + std::to_string(id) + " is not shared any more; share a body for it");
  // Nothing may be thrown where a haptic thread runs it.
  Refusal refusal = Refusal::kNone;
  ObjectId other = 0;
  desk.run([&] {
    const std::optional<Grip> held = grips.grip();
    if (!object.body.is_held) {
      refusal = Refusal::kLeftToBullet;
    } else if (held && !held->is_fading && held->object != id) {
      refusal = Refusal::kHoldsOther;
      other = held->object;
    } else {
      grips.grab(object, at_B);
    }
  });
  if (refusal == Refusal::kLeftToBullet)
    throw Error("object " + std::to_string(id) +
                " is left to Bullet, so no hand can hold it; Site::warnings() says why");
  if (refusal == Refusal::kHoldsOther)
    throw Error("the hand holds object " + std::to_string(other) + "; release it first");
}

void Site::Impl::release() noexcept {
  desk.run([&] { grips.release(); });
}

}  // namespace tandem
