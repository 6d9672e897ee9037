#pragma once

#include <optional>
#include <vector>

#include "tandem/coordination/stability.h"

/// \file
/// Advice on the gains of a cooperation: how far each is from the border of stability, and what to
/// turn.
#pragma GCC visibility push(default)
namespace tandem {

/// A number of LoopSettings that may be turned.
enum class LoopGain {
  kCoordinationStiffness,  ///< K_t
  kCoordinationDamping,    ///< B_t
  kContactStiffness,       ///< K_vc
  kContactDamping,         ///< B_vc
  kDeviceDamping,          ///< b_dev
  kDelay,                  ///< T_d
};

/// All of them, in that order.
[[nodiscard]] const std::vector<LoopGain>& allLoopGains();

/// Its key in a scenario: "coordination.stiffness".
[[nodiscard]] const char* name(LoopGain gain) noexcept;
[[nodiscard]] const char* unit(LoopGain gain) noexcept;

/// A gain as all users share it; who differs has a factor of it.
[[nodiscard]] double valueOf(const LoopSettings& settings, LoopGain gain) noexcept;
void setValue(LoopSettings& settings, LoopGain gain, double value) noexcept;

/// Growth of a mode.
struct ModeGrowth {
  MotionMode mode = MotionMode::kCommon;
  Growth growth;
};

/// Finds the mode that grows fastest of those that last.
[[nodiscard]] ModeGrowth computeWorstGrowth(const LoopSettings& settings);
[[nodiscard]] double computeWorstRate(const LoopSettings& settings);

/// A search for the border of stability of a gain: by factors of `step`, below or above 1.
struct BorderSearch {
  double from = 0.0, to = 0.0;  ///< from the gain's value, or from the least above it
  double step = 1.15;
};

/// Nearest value at which stability is another than at the gain's own, to 1e-5 of it; empty if none
/// is found.
[[nodiscard]] std::optional<double> findBorder(const LoopSettings& settings, LoopGain gain,
                                               const BorderSearch& search);

/// How a gain stands to stability, all others as they are.
struct GainMargin {
  LoopGain gain{};
  double value = 0.0;  ///< as it is
  /// Nearest values at which the rate is 0, to 1e-5 of them; empty: none within the range searched,
  /// which is a factor of 1000, and to kLongestDelay.
  std::optional<double> below, above;
  double slope = 0.0;  ///< of the rate over the logarithm of the gain [1/s]; 0 if the gain is 0
};

/// `searches`: false leaves the two borders out, which take most of the time.
[[nodiscard]] GainMargin computeMargin(const LoopSettings& settings, LoopGain gain,
                                       bool searches = true);

/// A change of one gain that makes a cooperation stable, with 20 % beyond the border.
struct Remedy {
  LoopGain gain{};
  double value = 0.0;  ///< new
  double rate = 0.0;   ///< that it gives [1/s]
};

/// Tells a user before a touch how the gains behave.
struct Advice {
  std::vector<ModeGrowth> modes;  ///< in the order of listModes()
  std::vector<GainMargin> margins;
  std::optional<LoopGain> strongest;  ///< gain whose change by 1 % moves the rate most
  std::optional<double> largest_coordination_stiffness;  ///< stable at this delay; empty: no bound
  std::optional<Remedy>
      remedy;  ///< smallest single change, if it is unstable; empty: there is none

  /// Gives the mode that grows fastest of those that last.
  [[nodiscard]] const ModeGrowth& worst() const noexcept;
};

/// Throws as computeGrowth() does.
[[nodiscard]] Advice advise(const LoopSettings& settings);
/// The same with the margins of allLoopGains(), in that order: a caller may compute them in
/// threads.
[[nodiscard]] Advice advise(const LoopSettings& settings, std::vector<GainMargin> margins);

}  // namespace tandem
#pragma GCC visibility pop
