#pragma once

#include <array>
#include <cstdint>

#pragma GCC visibility push(default)
namespace tandem {

/// Sequence numbers received under one key (section 5 of coordination/STANDARD.md). Each number is
/// accepted once, and none that is 1024 or more behind the newest.
///
/// Call check() before opening a datagram and commit() after. A forged datagram never opens, so its
/// number never moves the window. Real-time safe; not thread safe.
class ReplayWindow {
 public:
  static constexpr std::uint64_t kSize = 1024;

  /// True if a datagram with this number may be opened.
  [[nodiscard]] bool check(std::uint64_t sequence) const noexcept;

  /// Accepts the number. False, without a change, if check() refuses it.
  [[nodiscard]] bool commit(std::uint64_t sequence) noexcept;

 private:
  static constexpr std::uint64_t kWords = kSize / 64;

  void moveTo(std::uint64_t newest) noexcept;

  std::array<std::uint64_t, kWords> taken_{};  // number n is bit n % 64 of word n / 64 % kWords
  std::uint64_t newest_ = 0;
  bool empty_ = true;
};

}  // namespace tandem
#pragma GCC visibility pop
