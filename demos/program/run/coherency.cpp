#include "run/coherency.h"

#include <algorithm>

#include "world/received_object.h"
#include "world/scene.h"

namespace tandem::demos {
namespace {

double computeDistance(const Site& one, const Site& other) {
  double distance = 0.0;
  for (ObjectId id = 0; static_cast<int>(id) < one.objectCount(); ++id)
    distance = std::max(distance, (one.object(id).p_W - other.object(id).p_W).norm());
  return distance;
}

}  // namespace

Coherency::Coherency(const std::vector<std::unique_ptr<SiteWorld>>& worlds)
    : worlds_(worlds), received_means_(worlds.size()), received_W_(worlds.size()) {
  for (std::size_t one = 0; one < worlds.size(); ++one)
    for (std::size_t other = one + 1; other < worlds.size(); ++other)
      pairs_.push_back({one, other, 0.0, 0.0});
  const Site& first = worlds[0]->site();
  if (first.objectCount() > 0)
    for (auto& heard : received_W_) heard.assign(worlds.size() - 1, first.object(0).p_W);
}

void Coherency::add() {
  if (worlds_[0]->site().objectCount() == 0) return;
  double largest = 0.0;
  for (PairCoherency& pair : pairs_) {
    const double distance = computeDistance(worlds_[pair.one]->site(), worlds_[pair.other]->site());
    pair.mean += distance;
    pair.max = std::max(pair.max, distance);
    largest = std::max(largest, distance);
  }
  mean_ += largest;
  max_ = std::max(max_, largest);
  for (std::size_t site = 0; site < worlds_.size(); ++site) addReceived(site);
}

void Coherency::addReceived(std::size_t s) {
  const Site& site = worlds_[s]->site();
  double sum = 0.0;
  for (std::size_t remote = 0; remote < received_W_[s].size(); ++remote) {
    const auto received = findObject(site.latest(static_cast<int>(remote)), 0);
    if (received) received_W_[s][remote] = received->p_W;
    sum += (site.object(0).p_W - received_W_[s][remote]).norm();
  }
  received_means_[s] += sum / static_cast<double>(received_W_[s].size());
}

void Coherency::finish(double ticks) {
  mean_ /= ticks;
  for (PairCoherency& pair : pairs_) pair.mean /= ticks;
  for (double& mean : received_means_) mean /= ticks;
}

}  // namespace tandem::demos
