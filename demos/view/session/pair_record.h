#pragma once

#include <array>
#include <memory>

#include "run/site_record.h"
#include "session/session_records.h"
#include "session/site_pair.h"

namespace tandem::view {

/// Records both sites of a pair, whether they tick live or in virtual time. A record has the sites'
/// time, so pauses and slow motion are not in it.
class PairRecord {
 public:
  /// Before the first tick of `pair`, which must outlive the last call, and must not tick any more
  /// when this is deleted. store() fills a folder of `records`.
  PairRecord(const demos::Scenario& scenario, SitePair& pair, SessionRecords& records);

  /// After host steps that end by `time` [s], in their thread: keeps pictures that are due.
  void noteStep(double time);

  // When no thread ticks any more:

  /// Stores what was recorded over `network`, as `tandem peer --out` does for each site. Does
  /// nothing if nothing was. Throws as SessionRecords::store().
  void store(const Impairments& network);

 private:
  void publish(const demos::OutputFolder& folder) const;

  demos::Scenario scenario_;
  SitePair& pair_;
  SessionRecords& records_;
  std::array<std::unique_ptr<demos::SiteRecord>, 2> sites_;
};

}  // namespace tandem::view
