#pragma once

#include <nlohmann/json_fwd.hpp>

#include "files/output_folder.h"
#include "peer/peer_run.h"

namespace tandem::demos {

/// Summary of one site's live run: the keys of summary.json that one site can know, its network and
/// its loop.
[[nodiscard]] nlohmann::json makePeerSummary(const PeerRun& run);

/// Publishes siteN.csv, sceneN.csv and siteN.json: all or, on an error, none.
void writePeerRun(const OutputFolder& folder, int site, const nlohmann::json& summary,
                  const PeerRun& run);

void printPeerSummary(const nlohmann::json& summary, int site);

}  // namespace tandem::demos
