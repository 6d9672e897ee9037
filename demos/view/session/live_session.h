#pragma once

#include <array>
#include <memory>
#include <thread>

#include "session/live_network.h"
#include "session/session.h"

namespace tandem::view {

/// Where a session is, for another one that goes on from there.
struct SessionPlaces {
  std::array<Vec3, 2> hands_W = {Vec3::Zero(), Vec3::Zero()};  ///< of both users [m]
  demos::BodyPlaces bodies;                                    ///< as user 1's site has them
};

/// Lets the hands of a scenario begin at these places.
void startHandsAt(const SessionPlaces& places, demos::Scenario& scenario);

/// Both sites of a scenario live in one process: two Bullet worlds, two haptic threads at the
/// scenario's rate, a network between them, and a thread that steps the worlds. User 1 is at the
/// device, user 2 moves as the scenario says.
class LiveSession final : public Session {
 public:
  /// `device` must outlive this. Bodies begin at rest at `places`, or where the scenario says.
  /// Throws as SiteWorld and HapticLoop do.
  LiveSession(const demos::Scenario& scenario, HapticDevice& device,
              const demos::BodyPlaces& places = {});
  /// Fades the forces and ends all threads.
  ~LiveSession() override;

  /// Changes the network while hands touch.
  void setNetwork(const Impairments& network) { network_.change(network); }
  [[nodiscard]] std::vector<std::string> notes() const override { return loops_[0]->notes(); }
  /// Ends the session, and tells where it was.
  [[nodiscard]] SessionPlaces end();

 private:
  void stop() noexcept;
  void stepWorlds(const std::stop_token& stop);
  void lookAtWorlds(double time);

  LiveNetwork network_;
  demos::SiteWorld own_, other_;
  SceneLook scene_look_;
  double host_rate_;
  bool may_hold_;
  double begin_ = 0.0;  ///< on the monotonic clock [s]
  std::array<std::unique_ptr<HapticLoop>, 2> loops_;
  std::jthread host_;  // the last: it ends before what it uses
};

}  // namespace tandem::view
