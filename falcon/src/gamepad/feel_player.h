#pragma once

#include "tandem/falcon/event_port.h"

namespace tandem {

/// Outcome of showing an effect.
enum class FeelNews {
  kSame,      ///< the device has it already
  kUploaded,  ///< the device took it
  kRefused
};

/// Plays one effect on a device and updates it, as games do: some drivers have room for few effects
/// and start each new one with a knock. The device ends an effect by itself after a second, so it
/// is played anew before. Not thread safe.
class FeelPlayer {
 public:
  /// The port must outlive the player.
  explicit FeelPlayer(EventPort& port) noexcept : port_(port) {}
  /// Erases the effect, which stops it.
  ~FeelPlayer();
  FeelPlayer(const FeelPlayer&) = delete;
  FeelPlayer& operator=(const FeelPlayer&) = delete;

  /// Shows `effect` from `now` [s] on; level 0 stops. A refused one leaves the last as it was; that
  /// ends by itself if none is taken.
  FeelNews show(const FeelEffect& effect, double now) noexcept;

 private:
  [[nodiscard]] FeelNews update(const FeelEffect& effect) noexcept;
  void stop() noexcept;

  EventPort& port_;
  int id_ = -1;  ///< of the effect; negative: none is uploaded
  FeelEffect shown_;
  bool is_playing_ = false;
  double played_at_ = 0.0;  ///< [s]
};

}  // namespace tandem
