#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "tandem/coordination/datagram_channel.h"

#pragma GCC visibility push(default)
namespace tandem {

/// The direction in which a link is cut.
enum class LinkCut : std::uint8_t { kNone, kForward, kBack };

/// Settings of an emulated link at one moment; equal for both directions except `cut`.
struct LinkSettings {
  Impairments impairments;
  double corrupt = 0.0;     ///< see ChannelConditions
  bool keep_order = false;  ///< see ChannelConditions
  bool outage = false;      ///< new datagrams are dropped in both directions
  LinkCut cut = LinkCut::kNone;
};

/// A change of settings; empty fields stay as they are.
struct LinkChange {
  double at = 0.0;                                          ///< time after the start [s]
  std::optional<double> delay, jitter;                      ///< [s]
  std::optional<double> loss, duplicate, reorder, corrupt;  ///< probabilities
  std::optional<bool> keep_order, outage;
  std::optional<LinkCut> cut;
  bool rebind = false;  ///< from now on the server sees the client at another port, as behind a NAT
};

/// Channel conditions of one direction. Pure; real-time safe.
[[nodiscard]] ChannelConditions conditionsOf(const LinkSettings& settings,
                                             Direction direction) noexcept;

/// Settings that change at planned times. A step of the delay models a change of route: datagrams
/// under way keep their delay. advance() is real-time safe; not thread safe.
class LinkPlan {
 public:
  /// Throws std::invalid_argument, naming the value, if a setting is ever out of range or a time is
  /// negative or goes back.
  explicit LinkPlan(const LinkSettings& start, std::vector<LinkChange> changes = {});

  /// Applies the changes that are due at `now` [s]. Returns how many of them rebind.
  std::size_t advance(double now) noexcept;

  [[nodiscard]] const LinkSettings& settings() const noexcept { return settings_; }
  /// Time of the next change [s]; infinity if none is left.
  [[nodiscard]] double nextChange() const noexcept;

 private:
  LinkSettings settings_;
  std::vector<LinkChange> changes_;
  std::size_t done_ = 0;  ///< number of changes applied
};

}  // namespace tandem
#pragma GCC visibility pop
