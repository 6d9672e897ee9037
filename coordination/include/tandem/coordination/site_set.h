#pragma once

#include <bitset>
#include <cstdint>

#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

/// A set of live sites. Pure value; real-time safe.
class SiteSet {
 public:
  SiteSet() = default;
  /// `bits`: bit i stands for the site with id i + 1.
  explicit SiteSet(std::uint64_t bits) noexcept : bits_(bits) {}
  /// All that there may be.
  [[nodiscard]] static SiteSet all() noexcept { return SiteSet(~std::uint64_t{0}); }

  /// Ids outside of 1 to kMaxPeerId are in no set.
  void add(PeerId site) noexcept { bits_ |= bitOf(site); }
  void remove(PeerId site) noexcept { bits_ &= ~bitOf(site); }
  [[nodiscard]] bool has(PeerId site) const noexcept { return (bits_ & bitOf(site)) != 0; }
  [[nodiscard]] int count() const noexcept {
    return static_cast<int>(std::bitset<kMaxPeerId>(bits_).count());
  }
  [[nodiscard]] std::uint64_t bits() const noexcept { return bits_; }

  /// The sites of both.
  [[nodiscard]] friend SiteSet operator&(SiteSet a, SiteSet b) noexcept {
    return SiteSet(a.bits_ & b.bits_);
  }
  [[nodiscard]] friend bool operator==(SiteSet a, SiteSet b) noexcept { return a.bits_ == b.bits_; }
  [[nodiscard]] friend bool operator!=(SiteSet a, SiteSet b) noexcept { return !(a == b); }

 private:
  [[nodiscard]] static std::uint64_t bitOf(PeerId site) noexcept {
    const std::uint32_t place = static_cast<std::uint32_t>(site) - 1;
    return place < kMaxPeerId ? std::uint64_t{1} << place : 0;
  }

  std::uint64_t bits_ = 0;
};

/// Says who takes part, as a site knows it. Told as state in every packet.
struct RollCall {
  SiteSet heard;     ///< sites that the sender hears, and itself
  SiteSet members;   ///< sites among which the sender shares its objects, and itself
  double age = 0.0;  ///< of the sender's site, >= 0, not more than it is [s]
};

}  // namespace tandem
#pragma GCC visibility pop
