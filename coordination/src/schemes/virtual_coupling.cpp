#include "schemes/remote_user.h"

namespace tandem {
namespace {

/// Users meet only through the shared object; K_t, B_t couple its copies. Source: Sankaranarayanan
/// & Hannaford 2008; "Scheme 1" of Li & Constantinescu 2009.
class VirtualCoupling final : public Scheme {
 public:
  std::string_view name() const noexcept override { return "virtual_coupling"; }

  RemoteUser makeRemoteUser(Island&, const StandInSettings&, const PointState&) const override {
    return {};
  }

  void follow(Island&, const RemoteUser&, const PointState&) const noexcept override {}
};

}  // namespace

const Scheme& virtualCouplingScheme() {
  static const VirtualCoupling scheme;
  return scheme;
}

}  // namespace tandem
