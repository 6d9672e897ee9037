#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tandem/plugin/haptic_loop.h"
#include "tandem/plugin/site.h"

#include "c/device.h"
#include "c/link.h"
#include "c/world.h"

namespace tandem::c_door {

/// Throws std::invalid_argument if a value is out of range or the settings are not from
/// tandem_default_site_settings().
[[nodiscard]] SiteSettings fromC(const TandemSiteSettings& settings);

class SiteEnd {
 public:
  static constexpr std::uint32_t kKind = 0x54735449;
  static constexpr const char* kName = "site";
  static constexpr const char* kUser = "nothing";

  SiteEnd(const SiteSettings& settings, TandemWorld& world, TandemDevice& device);
  ~SiteEnd();
  SiteEnd(const SiteEnd&) = delete;
  SiteEnd& operator=(const SiteEnd&) = delete;

  ObjectId share(TandemBody body, double damping);
  ObjectId shareTool(TandemBody body, std::uint32_t user, const Vec3& at_B);
  void unshare(std::uint32_t object);
  void shareAgain(std::uint32_t object, TandemBody body);
  [[nodiscard]] TandemObjectState objectState(std::uint32_t object) const;
  void shiftOrigin(const Vec3& offset_W);
  void grab(std::uint32_t object, const std::optional<Vec3>& at_B);
  void release();
  TandemBody connect(std::uint32_t peer, TandemLink& link, const Vec3& start_W);
  std::uint32_t tick(double now);
  void startLoop(int priority);
  void stopLoop() noexcept;

  [[nodiscard]] Site& site() noexcept { return site_; }
  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  template <typename Share>
  ObjectId shareBody(TandemBody body, Share share);
  /// Throws while a loop runs, before Site starts any work.
  void checkSetUp(const char* what) const;
  /// Throws unless `object` is one of this site.
  void checkObject(std::uint32_t object) const;

  World& world_;
  Use world_use_, device_use_;
  std::vector<Use> link_uses_;
  std::vector<MeshWay> mesh_ways_;
  bool has_simulated_link_ = false;
  std::vector<std::uint32_t> peers_;
  std::vector<TandemBody> shared_;  ///< by object; TANDEM_NO_BODY: unshared
  std::vector<TandemBody> proxies_;
  bool ticks_itself_;
  double last_tick_ = -std::numeric_limits<double>::infinity();
  Site site_;
  std::unique_ptr<HapticLoop> loop_;  ///< null: no loop runs
};

}  // namespace tandem::c_door

struct TandemSite : tandem::c_door::Handle<tandem::c_door::SiteEnd> {};
