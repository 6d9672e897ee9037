#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tandem/coordination/types.h"

#include "plot/table.h"

namespace tandem::demos::plot {

/// What a run is about. Every experiment that is neither of the paper's two is a playground.
enum class RunKind { kCooperation, kUserContact, kPlayground };

/// A body of a run's scene, as one site sees it.
struct SceneBody {
  int site = 1;
  std::string name;
  std::string role;  ///< object, proxy, device, neighbour or obstacle
  bool is_box = false;
  Vec3 half_extents = Vec3::Zero();  ///< of a box [m]
  double radius = 0.0;               ///< of a sphere [m]
  bool is_static = false;
};

inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// What one site measured; NaN where the run did not say.
struct SiteOutcome {
  double received_mean = kMissing;        ///< own object copy against the other as received [m]
  double contact_transitions = kMissing;  ///< how often contact went on or off
  double force_max = kMissing;            ///< largest force on the user [N]
  double force_mean = kMissing;           ///< mean force on the user [N]
  double device_end = kMissing;           ///< displacement along the axis at the end [m]
};

/// How a run against the clock went, over both sites.
struct LiveOutcome {
  double round_trip = kMissing;  ///< as site 1 measured it [s]
  double late_share = kMissing;  ///< of ticks that began more than half a period late, 0 to 1
};

/// One run folder: what was asked (`scenario`) and what came out, from summary.json.
struct Run {
  std::filesystem::path dir;
  std::string name;   ///< of the folder
  std::string title;  ///< the scenario's own, or the folder's name
  nlohmann::json scenario;
  RunKind kind = RunKind::kPlayground;
  std::string scheme;
  std::string scalar;                ///< scalar width of the Bullet build
  double mean_coherency = kMissing;  ///< mean |object 1 - object 2| at equal time [m]
  double max_coherency = kMissing;   ///< its largest value [m]
  std::array<SiteOutcome, 2> site;
  double real_time_factor = kMissing;
  std::string state_hash;
  std::vector<SceneBody> bodies;
  std::optional<LiveOutcome> live;  ///< of two `tandem peer`; nothing: in virtual time

  /// False when the scene is known to be without a shared object.
  [[nodiscard]] bool hasObject() const;

  /// A number of the scenario by JSON pointer, such as "/device/damping"; NaN when it is not there.
  [[nodiscard]] double setting(const std::string& pointer) const;
  /// A text of the scenario by JSON pointer; empty when it is not there.
  [[nodiscard]] std::string settingText(const std::string& pointer) const;
};

/// Reads summary.json of `dir`, or what two `tandem peer` have left there: site1.json, site2.json
/// and their tables. Throws UsageError naming file and key.
[[nodiscard]] Run loadRun(const std::filesystem::path& dir);

/// The JSON object that a text is; `source` names it in messages. Throws UsageError.
[[nodiscard]] nlohmann::json parseObject(const std::string& text, const std::string& source);

/// A run folder's summary, already read; `source` names it in messages. Throws UsageError.
[[nodiscard]] Run makeRun(nlohmann::json summary, const std::filesystem::path& dir,
                          const std::string& source);

/// As loadRun(), from text that is already there; `source` names it in messages.
[[nodiscard]] Run parseRun(const std::string& summary_text, const std::filesystem::path& dir,
                           const std::string& source);

/// The two ticks-by-row tables of a run, site1.csv and site2.csv. Throws UsageError.
[[nodiscard]] std::array<Table, 2> loadSites(const Run& run);

}  // namespace tandem::demos::plot
