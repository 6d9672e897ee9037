#include "schemes/remote_user.h"

namespace tandem {
namespace {

/// The remote user is a kinematic body at the delayed position and velocity, held between packets.
/// Source: Fotoohi, Sirouspour & Capson 2007; "Scheme 2" of Li & Constantinescu 2009.
class KinematicProxy final : public Scheme {
 public:
  std::string_view name() const noexcept override { return "kinematic_proxy"; }

  RemoteUser makeRemoteUser(Island& island, const StandInSettings& stand_in,
                            const PointState& start) const override {
    IslandBody body;
    body.shape = Sphere{stand_in.proxy.radius};
    body.motion = Motion::kHeld;
    body.contact_share = stand_in.share;
    body.start.p_W = start.p_W;
    body.start.v_W = start.v_W;
    return {island.addBody(body), std::nullopt};
  }

  void follow(Island& island, const RemoteUser& user,
              const PointState& latest) const noexcept override {
    RigidState state;
    state.p_W = latest.p_W;
    state.v_W = latest.v_W;
    island.setState(*user.body, state);
  }
};

}  // namespace

const Scheme& kinematicProxyScheme() {
  static const KinematicProxy scheme;
  return scheme;
}

}  // namespace tandem
