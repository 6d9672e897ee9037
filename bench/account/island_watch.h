#pragma once

#include <memory>
#include <vector>

#include "tandem/coordination/simulated_link.h"

#include "bench/account/energy_account.h"
#include "coordination/src/schemes/remote_user.h"

namespace tandem::demos::bench {

/// Looks into a site's island at any moment of a tick, using only the public interface. A scheme
/// has the island, and is called when a packet is taken in; the island stops there for it.
///
///   WatchingScheme   the real scheme, and a look before and after each packet
///   WatchedLink      the real link, and repeated packets between the real ones, which only make
///                    the island stop
class IslandWatch final : public Scheme {
 public:
  explicit IslandWatch(const Scheme& scheme) : scheme_(scheme) {}

  /// Sends all looks to `account` from now on; null: none.
  void setAccount(EnergyAccount* account) { account_ = account; }
  [[nodiscard]] const EnergyAccount* account() const { return account_; }
  /// Sets the time at which the packet handed out last is taken in [s].
  void setTime(std::size_t remote, double time) { times_[remote] = time; }
  /// Null before a remote is connected.
  [[nodiscard]] const Island* island() const { return island_; }

  [[nodiscard]] std::string_view name() const noexcept override { return scheme_.name(); }
  [[nodiscard]] RemoteUser makeRemoteUser(Island& island, const StandInSettings& stand_in,
                                          const PointState& start) const override;
  void follow(Island& island, const RemoteUser& user,
              const PointState& latest) const noexcept override;

 private:
  const Scheme& scheme_;
  mutable const Island* island_ = nullptr;
  mutable std::vector<BodyIndex> bodies_;  ///< body of each remote; -1: none
  mutable std::vector<double> times_;
  EnergyAccount* account_ = nullptr;
};

/// A link with a look at each packet. `start` is the site's knowledge of the remote before the
/// first one. If `most_looks` is above 0, it repeats packets as often as the account needs.
class WatchedLink final : public Link {
 public:
  WatchedLink(Link& link, IslandWatch& watch, std::size_t remote, const StatePacket& start,
              double haptic_period, int most_looks);

  void send(const StatePacket& packet, double now) noexcept override { link_.send(packet, now); }
  [[nodiscard]] std::optional<Arrival> receive(double from, double until) noexcept override;

 private:
  [[nodiscard]] Arrival repeat(double time) noexcept;

  Link& link_;
  IslandWatch& watch_;
  std::size_t remote_;
  StatePacket latest_;
  double period_;
  int most_looks_;
  std::optional<Arrival> real_;  ///< received, not yet handed out
  enum class Stage { kNothing, kBefore, kAfter } stage_ = Stage::kNothing;
  double time_ = 0.0;        ///< time of the packet handed out last [s]
  double tick_ = -1.0;       ///< start of the current tick [s]
  double next_look_ = 0.0;   ///< [s]
  bool is_planned_ = false;  ///< next_look_ is set
};

}  // namespace tandem::demos::bench
