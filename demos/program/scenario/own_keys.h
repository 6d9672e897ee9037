#pragma once

#include <array>
#include <string_view>

namespace tandem::demos {

/// True for keys that concern one site only: two sites of one cooperation may differ in them.
[[nodiscard]] inline bool isOwnKey(std::string_view key) {
  constexpr std::array<std::string_view, 15> kOwn = {"title",
                                                     "site1.",
                                                     "site2.",
                                                     "device.",
                                                     "guard.",
                                                     "network.delay",
                                                     "network.jitter",
                                                     "network.loss",
                                                     "network.duplicate",
                                                     "network.reorder",
                                                     "network.seed",
                                                     "rates.host",
                                                     "rates.inner",
                                                     "experiment.duration",
                                                     "bridge."};
  for (const std::string_view own : kOwn)
    if (key.substr(0, own.size()) == own) return true;
  return false;
}

}  // namespace tandem::demos
