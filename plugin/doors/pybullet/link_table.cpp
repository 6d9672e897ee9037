#include "link_table.h"

#include <map>
#include <mutex>

#include "refusal.h"

namespace tandem::pybullet {
namespace {

struct Pair {
  TandemNetwork network;
  LinkHandle other;  // the end that is still free
  int in_use = 0;
};

struct Table {
  std::mutex mutex;
  std::map<std::string, Pair> pairs;
};

Table& table() {
  static Table the_table;
  return the_table;
}

bool areEqual(const TandemNetwork& a, const TandemNetwork& b) {
  return a.delay == b.delay && a.jitter == b.jitter && a.loss == b.loss &&
         a.duplicate == b.duplicate && a.reorder == b.reorder && a.seed == b.seed;
}

}  // namespace

SimulatedEnd::SimulatedEnd(const std::string& name, const TandemNetwork& network) : name_(name) {
  Table& all = table();
  const std::lock_guard lock(all.mutex);
  const auto known = all.pairs.find(name);
  if (known == all.pairs.end()) {
    TandemLink* first = nullptr;
    TandemLink* second = nullptr;
    check(tandem_link_create_simulated(&network, &first, &second));
    link_.reset(first);
    Pair& pair = all.pairs[name];
    pair.network = network;
    pair.other.reset(second);
    pair.in_use = 1;
    return;
  }
  Pair& pair = known->second;
  if (!pair.other) {
    throw Refusal(kWrongOrder, "link " + name + " has both its ends in use: take another name");
  }
  if (!areEqual(pair.network, network)) {
    throw Refusal(kWrongOrder,
                  "link " + name + " was made with other numbers: give the same at both ends");
  }
  link_ = std::move(pair.other);
  ++pair.in_use;
}

SimulatedEnd::~SimulatedEnd() {
  Table& all = table();
  const std::lock_guard lock(all.mutex);
  link_.reset();
  const auto known = all.pairs.find(name_);
  if (known != all.pairs.end() && --known->second.in_use == 0) all.pairs.erase(known);
}

}  // namespace tandem::pybullet
