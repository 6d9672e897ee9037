#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "tandem/coordination/stability.h"

#include "demos/program/run/site_links.h"
#include "demos/program/scenario/scenario.h"
#include "demos/program/world/scene.h"
#include "stability/drawn/pressing_hand.h"

namespace tandem::test {

/// One of these keeps the cube on the line along which users press.
enum class Keeping {
  kGuide,    ///< the scenario's guide, which keeps the devices, too
  kFactors,  ///< factors of Bullet; hands keep the devices
  kNothing   ///< the cube may turn; hands keep the devices
};

/// The sites of the scenario that an analysis is of, in virtual time, without guards that the
/// analysis lacks. All users press the cube along a line, or each other, so that all contacts stay
/// closed.
class PressedSites {
 public:
  /// `calm`: spring and damper by which hands hold their devices besides, until letGo(). A cube
  /// that may turn is pressed lightly, near its middle.
  PressedSites(const LoopSettings& settings, const HandImpedance& calm,
               Keeping keeping = Keeping::kGuide);

  /// Lets all ticks of a haptic period happen.
  void tick();
  void letGo();
  /// Pushes each device by its part of `impulses` [N s] during the next tick.
  void nudge(const Eigen::VectorXd& impulses);
  /// Pulls each device along the line from now on [N].
  void pull(double force);

  [[nodiscard]] double now() const noexcept {
    return static_cast<double>(ticks_) / scenario_.site.haptic_rate;
  }
  /// Of the devices, then of the copies, along the axis [m/s].
  [[nodiscard]] Eigen::VectorXd velocities();
  /// Force of the contact that is closest to opening, over its stiffness [m]; below 0: it is open.
  [[nodiscard]] double findLeastDepth();

 private:
  [[nodiscard]] double findLeastDepth(Site& site) const;

  [[nodiscard]] SimulatedDeviceSettings makeDevice(int site) const;

  demos::Scenario scenario_;
  long ticks_ = 0;
  demos::SiteLinks links_;
  std::vector<PressingHand*> hands_;
  std::vector<std::unique_ptr<SimulatedDevice>> devices_;
  std::vector<std::unique_ptr<demos::SiteWorld>> worlds_;
};

}  // namespace tandem::test
