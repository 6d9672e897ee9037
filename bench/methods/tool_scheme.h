#pragma once

#include <string_view>

#include "bench/scenes/bench_scene.h"
#include "coordination/src/schemes/remote_user.h"

namespace tandem::demos::bench {

/// A scene's tools as remote dynamic proxies with the scene's own gains. Shared objects need no
/// coupler to copies elsewhere: the scenes have one copy of each.
class ToolScheme final : public Scheme {
 public:
  explicit ToolScheme(const BenchScene& scene) {
    if (!scene.tools.empty() && scene.tools.front().device) gains_ = scene.coupler;
  }
  std::string_view name() const noexcept override { return "bench_tool"; }
  RemoteUser makeRemoteUser(Island& island, const StandInSettings& stand_in,
                            const PointState& start) const override {
    return proxies_.makeRemoteUser(island, {stand_in.share, stand_in.proxy, gains_}, start);
  }
  void follow(Island& island, const RemoteUser& user,
              const PointState& latest) const noexcept override {
    proxies_.follow(island, user, latest);
  }

 private:
  CouplerGains gains_{0.0, 0.0};
  const Scheme& proxies_ = findScheme("remote_dynamic_proxy");
};

}  // namespace tandem::demos::bench
