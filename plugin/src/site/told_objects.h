#pragma once

#include <vector>

#include "tandem/coordination/link.h"

#include "site/object_motion.h"

namespace tandem {

/// Room for objects in a packet.
struct PacketRoom {
  std::size_t places = kMaxObjectsPerPacket;  ///< at least 1
  bool fills = true;            ///< objects that are not due get the places that are left
  bool prefers_nearest = true;  ///< false: the ones told longest ago go first
  double next = 0.0;  ///< time until the peer's next packet, if it gets that for certain [s]
};

/// Remembers what one peer has been told of the shared objects, and chooses what it is told next.
///
/// An object that moves is due at a rate by its nearness. One that has come to rest is due a few
/// times more, as packets get lost. The most urgent go first: those that have waited long, moved
/// far, or are near. One place of each packet goes round all objects, so none waits for ever.
/// Real-time safe after setCount().
class ToldObjects {
 public:
  /// `packet_rate` [Hz] is that of touched objects.
  explicit ToldObjects(double packet_rate) noexcept : packet_rate_(packet_rate) {}

  /// Allocates.
  void setCount(std::size_t count);
  /// The peer may have lost all that it knew at `time` [s].
  void forget(double time) noexcept;

  void look(std::size_t object, Nearness nearness, double time) noexcept {
    told_[object].nearness.update(nearness, time);
  }
  /// To the nearer of both users' hands.
  [[nodiscard]] Nearness nearness(std::size_t object) const noexcept {
    return told_[object].nearness.value();
  }

  /// Chooses for a packet of `time` [s] and notes them as told. Indices in ascending order, valid
  /// until the next call.
  const std::vector<std::size_t>& choose(const std::vector<ObjectMotion>& motions,
                                         const PacketRoom& room, double time) noexcept;

 private:
  struct Told {
    double at = 0.0;         ///< time of the packet [s]
    double travelled = 0.0;  ///< then [m]
    int repeats = 1;         ///< times to tell it more, though it is the same
    HeldNearness nearness;
    bool is_chosen = false;
  };
  struct Candidate {
    std::size_t object = 0;
    double urgency = 0.0;
  };

  [[nodiscard]] double computeRate(const Told& told, const ObjectMotion& motion) const noexcept;
  void findUrgent(const std::vector<ObjectMotion>& motions, const PacketRoom& room,
                  double time) noexcept;
  void add(const Candidate& candidate, std::size_t most) noexcept;
  void choose(std::size_t object) noexcept;
  void goRound(std::size_t until) noexcept;

  double packet_rate_;
  std::vector<Told> told_;
  std::vector<Candidate> urgent_;  ///< the most urgent first
  std::vector<std::size_t> chosen_;
  std::size_t next_ = 0;  ///< of the place that goes round
};

}  // namespace tandem
