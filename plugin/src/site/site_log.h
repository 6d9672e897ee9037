#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "tandem/plugin/recording.h"
#include "tandem/plugin/site.h"

#include "site/bodies.h"
#include "site/rest_mark.h"
#include "site/state_hash.h"

namespace tandem {

class LocalHand;
class Peers;

/// Status bits that stay set and stop the island. A missing body does so if stop() says it.
inline constexpr std::uint32_t kForGood = kStateNotFinite | kWorldGone;

/// Reports of a site: status bits, counters, a hash of its states, a recording, warnings.
class SiteLog {
 public:
  SiteCounters counters;
  Recording* recording = nullptr;
  std::vector<std::string> warnings;  ///< of bodies that the site released

  // The haptic thread raises bits of the present tick; the host's thread raises bits that stay.
  void startTick() noexcept {
    now_ = ((ever_ | of_host_) & kForGood) | stopped_by_ | (is_missing_ ? kBodyMissing : kTickOk);
  }
  void raise(std::uint32_t bits) noexcept {
    now_ |= bits;
    if (bits & kStateNotFinite) has_diverged_ = true;
  }
  std::uint32_t endTick() noexcept {
    ever_ |= now_;
    return now_;
  }
  void raiseFromHost(std::uint32_t bits) noexcept { of_host_ |= bits; }
  /// Raises bits and stops the island for good.
  void stop(std::uint32_t bits) noexcept {
    raiseFromHost(bits);
    stopped_by_ |= bits;
  }
  /// Ticks report kBodyMissing while an object is not in the host's world.
  void setMissing(bool is_missing) noexcept {
    if (is_missing) raiseFromHost(kBodyMissing);
    is_missing_ = is_missing;
  }
  /// True once states of the island were not finite.
  [[nodiscard]] bool hasDiverged() const noexcept { return has_diverged_; }
  [[nodiscard]] std::uint32_t status() const noexcept { return ever_ | of_host_; }
  [[nodiscard]] bool isWorldGone() const noexcept { return (of_host_ & kWorldGone) != 0; }
  /// True if this tick has no usable force: the force fades.
  [[nodiscard]] bool hasFault() const noexcept {
    return (now_ & kDeviceInvalid) != 0 || hasStopped();
  }
  /// True if the island has stopped for good.
  [[nodiscard]] bool hasStopped() const noexcept {
    return (now_ & kForGood) != 0 || stopped_by_ != kTickOk;
  }

  /// Hashes the states at the start of a tick, if anything has moved.
  void addToHash(double now, const Vec3& force_W, const Island& island) noexcept;
  [[nodiscard]] std::uint64_t hash() const noexcept { return hash_.value(); }

  void countForces(const LocalHand& hand) noexcept;

  void recordArrival(int peer, const Arrival& arrival) noexcept {
    if (recording) recording->addArrival({peer, arrival});
  }
  /// With a recording. `reads_bullet`: Bullet may be read, as no other thread steps the world now.
  void recordTick(double now, const LocalHand& hand, const Bodies& bodies, const Peers& peers,
                  const Island& island, bool reads_bullet) noexcept;

  /// After set-up. Allocates.
  void makeRoom(std::size_t objects, std::size_t peers);

 private:
  std::uint32_t now_ = kTickOk, ever_ = kTickOk;
  std::atomic<std::uint32_t> of_host_{kTickOk}, stopped_by_{kTickOk};
  std::atomic<bool> is_missing_{false}, has_diverged_{false};
  StateHash hash_;
  RestMark hash_rest_;  ///< when states last went into the hash
  std::vector<BodyRecord> objects_, proxies_;
};

/// True if the states of all awake bodies are finite.
[[nodiscard]] bool areAwakeFinite(const Island& island) noexcept;

}  // namespace tandem
