#pragma once

#include <optional>
#include <vector>

#include "tandem/plugin/site.h"

#include "site/grip_hold.h"
#include "site/local_hand.h"
#include "site/peers.h"

namespace tandem {

// clang-format off
/// The grips of a site's hands.
///
///   local hand        Site::grab(), Site::release(); each changes the epoch that packets tell
///   a remote user     its proxy holds what the user's newest packet says
///
/// A grip ends when its object leaves the island or is put elsewhere. One that is pulled at its limit
/// for `break_time` breaks; a remote user's breaks at that user's site. A remote user's pulls with the
/// share of its link. For the thread that ticks; real-time safe unless it says that it allocates.
// clang-format on
class Grips {
 public:
  /// `can_hold`: the island moves the bodies, free of a guide.
  Grips(const SiteSettings& settings, Island& island, const Bodies& bodies, LocalHand& hand,
        const Peers& peers, SiteLog& log, bool can_hold);

  [[nodiscard]] bool canHold() const noexcept { return local_.has_value(); }
  /// Set-up: the peer that is about to be added may hold objects, too. Allocates.
  void addPeer(const Peer& peer);

  /// The local hand takes hold of an object of the island. The local user's tool does not break
  /// off.
  void grab(const SharedObject& object, const std::optional<Vec3>& at_B) noexcept;
  void release() noexcept;
  /// The local grip, if there is one.
  [[nodiscard]] std::optional<Grip> grip() const noexcept;

  /// Called once a tick of `period` [s] that starts at `now` [s], after hand, packets and links.
  void follow(double now, double period) noexcept;
  /// The local hand holds something, or has just let go.
  [[nodiscard]] bool isBusy() const noexcept { return local_ && local_->isOn(); }
  /// Torque of the local grip on the hand, in W [N m].
  [[nodiscard]] Vec3 computeTorque() const noexcept;
  /// For a packet whose state belongs to `time` [s].
  [[nodiscard]] std::optional<GripState> state(double time) const noexcept;

 private:
  /// A remote user's hold; empty without a body of the user.
  struct Remote {
    std::optional<GripHold> hold;
    ObjectEpoch epoch;
  };

  void followLocal(double period) noexcept;
  void followPeer(const Peer& peer, Remote& remote, double now, double period) noexcept;
  void noteChange() noexcept;
  [[nodiscard]] double countSites() const noexcept;
  [[nodiscard]] const SharedObject* findTold(const Peer& peer) const noexcept;

  const SiteSettings& settings_;
  Island& island_;
  const Bodies& bodies_;
  LocalHand& hand_;
  const Peers& peers_;
  SiteLog& log_;
  std::optional<GripHold> local_;
  std::vector<Remote> remotes_;  ///< by place of the peer
  ObjectEpoch local_epoch_;      ///< of the object at the grab
  std::uint16_t epoch_ = 0;      ///< of the local grip
  bool has_changed_ = false;     ///< something was held once
  bool is_new_ = false;          ///< the last change was after the latest tick
  double changed_at_ = 0.0;      ///< time of the last change [s]
};

}  // namespace tandem
