#pragma once

#include <optional>
#include <vector>

#include "coordination/src/wire/wire_agree.h"

namespace tandem::net {

/// Compares the configurations of this site and a peer, in both directions, part by part.
class Agreement {
 public:
  /// Throws std::invalid_argument if the configuration is too long to be sent.
  explicit Agreement(const Configuration& here);

  /// Sends all parts again, because the peer may have restarted.
  void restart() noexcept;

  /// Takes a part of the peer's configuration. Returns the payload size of our answer, 0 if there
  /// is none. For set-up: allocates.
  [[nodiscard]] std::size_t onAgree(const AgreePart& part, ByteSpan answer);
  void onAnswer(const AgreeAnswer& answer);

  /// Writes the next part that the peer has not acknowledged. Returns 0 after the last one.
  [[nodiscard]] std::size_t nextPart(ByteSpan payload);
  /// True until the peer has acknowledged all parts.
  [[nodiscard]] bool hasMoreToSay() const noexcept { return !is_heard_; }

  /// True if both sites found the configurations equal.
  [[nodiscard]] bool isEqual() const noexcept { return is_equal_here_ && is_equal_there_; }
  /// First item that differs, as found by either site.
  [[nodiscard]] const std::optional<ConfigurationDifference>& difference() const noexcept {
    return difference_;
  }
  [[nodiscard]] std::uint32_t hash() const noexcept { return hash_; }

 private:
  Configuration here_;
  std::uint32_t hash_;
  std::vector<AgreePart> parts_;
  AgreeCollector collector_;
  std::uint32_t acknowledged_ = 0;
  std::size_t next_ = 0;
  bool is_heard_ = false, is_equal_here_ = false, is_equal_there_ = false;
  std::optional<ConfigurationDifference> difference_;
};

}  // namespace tandem::net
