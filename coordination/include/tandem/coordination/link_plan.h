#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "tandem/coordination/datagram_channel.h"

#pragma GCC visibility push(default)
namespace tandem {

/// A way that lets nothing through in one direction.
enum class LinkCut : std::uint8_t { kNone, kForward, kBack };

/// What an emulated link does at a moment; the same in both directions, but for `cut`.
struct LinkSettings {
  Impairments impairments;
  double corrupt = 0.0;     ///< see ChannelConditions
  bool keep_order = false;  ///< see ChannelConditions
  bool outage = false;      ///< nothing gets onto the way in either direction
  LinkCut cut = LinkCut::kNone;
};

/// A change of settings; what is not named stays.
struct LinkChange {
  double at = 0.0;                                          ///< after the start [s]
  std::optional<double> delay, jitter;                      ///< [s]
  std::optional<double> loss, duplicate, reorder, corrupt;  ///< probabilities
  std::optional<bool> keep_order, outage;
  std::optional<LinkCut> cut;
  bool rebind = false;  ///< from now on the server sees the client at another port, as behind a NAT
};

/// `settings` as they apply to one direction. Pure; real-time safe.
[[nodiscard]] ChannelConditions conditionsOf(const LinkSettings& settings,
                                             Direction direction) noexcept;

/// Settings that change at times known beforehand. A step of the delay is a change of route; what
/// is under way keeps the delay it was sent with. advance() is real-time safe; not thread safe.
class LinkPlan {
 public:
  /// Throws std::invalid_argument, naming the value, for settings out of range at any time, or
  /// times that are negative or go back.
  explicit LinkPlan(const LinkSettings& start, std::vector<LinkChange> changes = {});

  /// Makes the changes that are due at `now` [s]. The number of rebinds among them.
  std::size_t advance(double now) noexcept;

  [[nodiscard]] const LinkSettings& settings() const noexcept { return settings_; }
  /// When advance() has something to do next [s]; infinity if never.
  [[nodiscard]] double nextChange() const noexcept;

 private:
  LinkSettings settings_;
  std::vector<LinkChange> changes_;
  std::size_t done_ = 0;  ///< of changes_
};

}  // namespace tandem
#pragma GCC visibility pop
