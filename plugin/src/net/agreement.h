#pragma once

#include <optional>
#include <vector>

#include "coordination/src/wire/wire_agree.h"

namespace tandem::net {

/// Compares this site's configuration with a peer's, in both directions, part by part.
class Agreement {
 public:
  /// Throws std::invalid_argument if the configuration is too long to be sent.
  explicit Agreement(const Configuration& here);

  /// The peer is to be told again: it may have begun anew.
  void restart() noexcept;

  /// The peer's part; gives the payload size of our answer, 0 if there is none. For set-up:
  /// allocates.
  [[nodiscard]] std::size_t onAgree(const AgreePart& part, ByteSpan answer);
  void onAnswer(const AgreeAnswer& answer);

  /// Part after part that the peer has not acknowledged, and then 0.
  [[nodiscard]] std::size_t nextPart(ByteSpan payload);
  /// True until the peer has acknowledged all parts.
  [[nodiscard]] bool hasMoreToSay() const noexcept { return !is_heard_; }

  /// Both have said that both are equal.
  [[nodiscard]] bool isEqual() const noexcept { return is_equal_here_ && is_equal_there_; }
  /// The first item that differs, as either side found it.
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
