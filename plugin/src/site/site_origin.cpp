#include <stdexcept>

#include "site/site_impl.h"

namespace tandem {

/// Everything moves by the same offset, so nothing moves relative to anything. Between two ticks,
/// and while the host's thread waits: no part sees half of it.
void Site::Impl::shiftOrigin(const Vec3& offset_W) {
  if (!offset_W.allFinite())
    throw std::invalid_argument(
        "an origin is shifted by finite numbers of metres; check the offset");
  if (settings.contact_model != ContactModel::kIsland)
    throw Error(
        "a native model has constraints at fixed places of the world; destroy the site, shift the "
        "origin, and make a new site");
  rest.disturb();
  desk.run([&] {
    island.shiftOrigin(offset_W);
    timeline.shiftOrigin(offset_W);
    hand.shiftOrigin(offset_W);
    peers.shiftOrigin(offset_W);
    surroundings.shiftOrigin(offset_W);
    for (SharedObject& object : bodies.objects) object.shiftOrigin(offset_W);
    for (Peer& peer : peers) peer.proxy.body.shiftOrigin(offset_W);
  });
  // Proxies are in the host's world, but hosts know only of their own bodies.
  for (Peer& peer : peers)
    if (peer.proxy.body.bullet && peer.proxy.findRigid())
      peer.proxy.body.bullet->asRigid()->putBack();
}

}  // namespace tandem
