#pragma once

#include <future>
#include <optional>
#include <string>

#include "tandem/coordination/safe_coordination.h"
#include "tandem/coordination/stability_advice.h"

#include "scenario/scenario.h"

namespace tandem::demos {

/// Follows the delay of a live session, and tells when its gains fit that delay no more. Analyses
/// in a thread of its own, so that callers never wait but in the destructor.
class GrowthWatch {
 public:
  /// Tells nothing of a scenario that cannot be analysed.
  explicit GrowthWatch(const Scenario& scenario);

  /// Takes the delay as it is measured, one way and with playout [s]. Gives a line when the verdict
  /// is another one than before; gains fit until the first.
  [[nodiscard]] std::optional<std::string> look(double delay);
  /// True until a look() takes the analysis that an earlier one has begun.
  [[nodiscard]] bool isAnalysing() const noexcept { return running_.valid(); }

 private:
  struct Verdict {
    double delay = 0.0;  ///< [s]
    ModeGrowth worst;
    std::optional<SafeCoordination> better;  ///< gains that fit, if the session's do not
  };

  [[nodiscard]] static Verdict judge(LoopSettings loop, double delay);
  [[nodiscard]] bool isNews(double delay) const noexcept;
  [[nodiscard]] static std::string tell(const Verdict& verdict);

  std::optional<LoopSettings> loop_;
  std::future<Verdict> running_;
  std::optional<double> judged_;  ///< delay of the latest analysis [s]
  bool fits_ = true;
};

}  // namespace tandem::demos
