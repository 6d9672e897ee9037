#pragma once

#include <vector>

#include <Eigen/Core>

#include "tandem/coordination/stability.h"

namespace tandem::stability {

/// Packets of one site, on their way to those who hear them.
struct Channel {
  int source = 0;
  double delay = 0.0;  ///< [s]
  double phase = 0.0;  ///< of its packets, in packet periods, 0 to 1
};

/// Sites along one axis, and what each hears. Equal users need one site that hears itself.
struct LoopModel {
  LoopSettings settings;
  int sites = 1;
  std::vector<Channel> channels;
  Eigen::MatrixXd weights;  ///< site by channel: how much of it the site hears
};

/// Equal users need one site, which hears its own past N - 1 times, with a sign, or not. Others
/// need all sites.
[[nodiscard]] LoopModel makeModeModel(const LoopSettings& settings, MotionMode mode);

/// All users by themselves, whose packets are sent `phases` of a period apart; empty: in phase.
[[nodiscard]] LoopModel makeFullModel(const LoopSettings& settings,
                                      const std::vector<double>& phases = {});

/// Places of the values in a state: position, then velocity behind it. -1: there is none.
struct SitePlaces {
  int device = 0, hip = 2, force = 4, object = -1, proxy = -1;
};
struct ChannelPlaces {
  int device = -1, object = -1;  ///< as told by the packet that is in force
};

/// Motion between events, x' = A x, and the force that a tick sets.
class LoopSystem {
 public:
  explicit LoopSystem(const LoopModel& model);

  [[nodiscard]] int size() const noexcept { return static_cast<int>(rates_.rows()); }
  [[nodiscard]] const Eigen::MatrixXd& rates() const noexcept { return rates_; }
  /// Place of a constant force on each device, which is 0 in a free motion.
  [[nodiscard]] int push() const noexcept { return size() - 1; }
  /// Row of a site's force on its device.
  [[nodiscard]] const Eigen::RowVectorXd& force(int site) const noexcept {
    return forces_[static_cast<std::size_t>(site)];
  }
  [[nodiscard]] const SitePlaces& site(int i) const noexcept {
    return sites_[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] const ChannelPlaces& channel(int c) const noexcept {
    return channels_[static_cast<std::size_t>(c)];
  }

 private:
  void placeAll(const LoopModel& model);
  void addDevice(const LoopModel& model, int i);
  void addProxy(const LoopModel& model, int i);
  void addObject(const LoopModel& model, int i);
  void addForce(const LoopModel& model, int i);

  std::vector<SitePlaces> sites_;
  std::vector<ChannelPlaces> channels_;
  Eigen::MatrixXd rates_;
  std::vector<Eigen::RowVectorXd> forces_;
};

}  // namespace tandem::stability
