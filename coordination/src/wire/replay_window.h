#pragma once

#include <array>
#include <cstdint>

#pragma GCC visibility push(default)
namespace tandem {

/// Which sequence numbers under one key were taken (section 5 of coordination/STANDARD.md): each is
/// taken once, and none that is 1024 or more behind the newest.
///
/// check() before a datagram is opened, commit() after it was: a forged number, however far ahead,
/// never opens and so never moves the window. Real-time safe; not thread safe.
class ReplayWindow {
 public:
  static constexpr std::uint64_t kSize = 1024;

  /// True if a datagram with this number may be opened.
  [[nodiscard]] bool check(std::uint64_t sequence) const noexcept;

  /// Takes the number; false, and nothing changes, if check() says no.
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
