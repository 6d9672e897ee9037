#include "island/touch_memory.h"

namespace tandem {

double TouchMemory::allowance(const TouchKey& key, double ahead) const noexcept {
  for (const Entry& entry : entries_)
    if (entry.key == key) return entry.allowance + ahead * entry.speed;
  return 0.0;
}

void TouchMemory::keepDepth(const TouchKey& key, double depth) noexcept {
  if (Entry* entry = findOrAdd(key)) entry->depth = depth;
}

void TouchMemory::letIn(const TouchKey& key, double depth, double noticed) noexcept {
  const auto known = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& entry) { return entry.key == key; });
  const double growth = depth - (known == entries_.end() ? 0.0 : known->depth);
  if (!(growth > noticed)) return;
  Entry* entry = findOrAdd(key);
  if (entry == nullptr) return;
  entry->depth = depth;
  entry->allowance += growth;
  entry->speed = std::min(kTopSpeed, entry->allowance / kShortestTime);
}

void TouchMemory::forget(BodyIndex body) noexcept {
  std::erase_if(entries_, [&](const Entry& entry) {
    return entry.key.sphere == body || entry.key.other == body;
  });
}

TouchMemory::Entry* TouchMemory::findOrAdd(const TouchKey& key) noexcept {
  for (Entry& entry : entries_)
    if (entry.key == key) return &entry;
  if (entries_.size() == entries_.capacity()) return nullptr;
  entries_.push_back({key});
  return &entries_.back();
}

}  // namespace tandem
