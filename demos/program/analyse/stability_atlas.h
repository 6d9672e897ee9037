#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "analyse/growth_map.h"
#include "analyse/stability_curves.h"
#include "files/output_folder.h"

namespace tandem::demos {

/// Curves of one figure.
struct AtlasCurves {
  std::string name;  ///< "damping"
  CurveSet set;
};

/// Maps and curves of one scenario.
struct StabilityAtlas {
  std::string title;
  LoopSettings loop;
  std::vector<GrowthMap> maps;
  std::vector<AtlasCurves> curves;
};

using AtlasProgress = std::function<void(double share)>;

/// One map of the loop as it is.
[[nodiscard]] StabilityAtlas makeMapAtlas(const std::string& title, const LoopSettings& loop,
                                          const std::pair<LoopGain, LoopGain>& gains,
                                          const MapSize& size, const AtlasProgress& show);

/// A map and curves for each scheme: the stiffness that meets the delay first, damping, users,
/// criteria, fine steps of the delay, and touches. Curves over the delay have four points for each
/// of a map.
[[nodiscard]] StabilityAtlas makeWholeAtlas(const std::string& title, const LoopSettings& loop,
                                            const MapSize& size, const AtlasProgress& show);

/// JSON of the format tandem-stability, which the figures are drawn from.
[[nodiscard]] std::string writeJson(const StabilityAtlas& atlas);

/// A folder for the files of an atlas: stability.json, a CSV file for each map, and figures.
class AtlasFolder {
 public:
  /// Throws UsageError if the folder cannot be written or holds other things, and Error if figures
  /// cannot be drawn here.
  explicit AtlasFolder(const std::string& folder);

  /// Replaces an earlier atlas. Returns the path of the JSON file. Throws Error.
  std::filesystem::path write(const StabilityAtlas& atlas) const;

 private:
  std::filesystem::path path_;
  OutputFolder files_;
};

}  // namespace tandem::demos
