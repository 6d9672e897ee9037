#include "session/pair_record.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace tandem::view {

PairRecord::PairRecord(const demos::Scenario& scenario, SitePair& pair, SessionRecords& records)
    : scenario_(scenario), pair_(pair), records_(records) {
  for (int site : {0, 1})
    sites_[static_cast<std::size_t>(site)] = std::make_unique<demos::SiteRecord>(
        scenario, site, site == 0 ? pair.own() : pair.other(), demos::kLongestRecord);
}

void PairRecord::noteStep(double time) {
  for (const auto& site : sites_) site->noteStep(time);
}

void PairRecord::store(const Impairments& network) {
  if (!std::ranges::all_of(sites_, [](const auto& site) { return site->hasAnything(); })) return;
  scenario_.network = network;
  records_.store([&](const demos::OutputFolder& folder) { publish(folder); });
}

void PairRecord::publish(const demos::OutputFolder& folder) const {
  for (std::size_t site : {0, 1})
    sites_[site]->write(folder, sites_[site]->summarise(scenario_, pair_.report(site)));
  demos::publishSites(folder, 1);
}

}  // namespace tandem::view
