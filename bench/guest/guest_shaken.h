#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "bench/guest/guest_case.h"
#include "bench/guest/guest_journal.h"

namespace tandem::demos::bench {

class GuestWorld;

/// A bare world of each site of a case, whose bodies start up to 10 mm/s, and half of what gravity
/// gives them in a step, faster or slower along each axis. What was done to the sites' twins is
/// done to them.
class ShakenTwin {
 public:
  /// Equal cases and numbers give equal starts.
  ShakenTwin(const GuestCase& one, std::uint64_t number);
  ~ShakenTwin();
  ShakenTwin(const ShakenTwin&) = delete;
  ShakenTwin& operator=(const ShakenTwin&) = delete;

  /// Does the frames of the sites' journals up to, but without, `end`.
  void advance(const std::vector<const GuestJournal*>& journals, std::size_t end);

  /// Energy that all worlds gained so far [J]; losses do not count.
  [[nodiscard]] double gained() const { return gained_; }
  /// True if a body of a site's world ever was below all that stands.
  [[nodiscard]] bool hasFallen(std::size_t site, std::size_t body) const {
    return has_fallen_[site][body] != 0;
  }
  [[nodiscard]] const GuestWorld& world(std::size_t site) const { return *worlds_[site]; }

 private:
  void look();

  std::vector<std::unique_ptr<GuestWorld>> worlds_;
  std::vector<std::vector<char>> has_fallen_;  ///< by site and body
  std::size_t next_ = 0;                       ///< frame
  double energy_ = 0.0, gained_ = 0.0;
};

/// Sixteen of them, made when they are asked for the first time.
///
/// In a chaotic world a site's bodies go another way than the twin's. What happens to one of the
/// shaken twins is Bullet's doing.
class ShakenTwins {
 public:
  explicit ShakenTwins(const GuestCase& one) : case_(one) {}

  void advance(const std::vector<const GuestJournal*>& journals);
  [[nodiscard]] double mostGained() const;
  [[nodiscard]] bool hasFallen(std::size_t site, std::size_t body) const;

 private:
  const GuestCase& case_;
  std::vector<std::unique_ptr<ShakenTwin>> twins_;
};

}  // namespace tandem::demos::bench
