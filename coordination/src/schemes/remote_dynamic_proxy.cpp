#include "schemes/remote_user.h"

namespace tandem {
namespace {

/// The remote user is a dynamic body with the mass of the user's device. K_t, B_t drive it towards
/// the user's delayed state: eqs (3), (4), (13), (14) of Li & Constantinescu 2009.
class RemoteDynamicProxy final : public Scheme {
 public:
  std::string_view name() const noexcept override { return "remote_dynamic_proxy"; }

  RemoteUser makeRemoteUser(Island& island, const StandInSettings& stand_in,
                            const PointState& start) const override {
    const ProxySettings& proxy = stand_in.proxy;
    IslandBody body;
    body.shape = Sphere{proxy.radius};
    body.mass = proxy.mass;
    body.damping = proxy.damping;
    body.contact_share = stand_in.share;
    body.feels_obstacles = true;
    body.start.p_W = start.p_W;
    body.start.v_W = start.v_W;
    const BodyIndex index = island.addBody(body);
    return {index, island.addCoupler(index, {stand_in.coordination, {}})};
  }

  void follow(Island& island, const RemoteUser& user,
              const PointState& latest) const noexcept override {
    RigidState target;
    target.p_W = latest.p_W;
    target.v_W = latest.v_W;
    island.setTarget(*user.coupler, target);
  }
};

}  // namespace

const Scheme& remoteDynamicProxyScheme() {
  static const RemoteDynamicProxy scheme;
  return scheme;
}

}  // namespace tandem
