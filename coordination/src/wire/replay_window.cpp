#include "wire/replay_window.h"

namespace tandem {
namespace {

constexpr std::uint64_t bitOf(std::uint64_t sequence) noexcept {
  return std::uint64_t{1} << (sequence % 64);
}

}  // namespace

bool ReplayWindow::check(std::uint64_t sequence) const noexcept {
  if (empty_ || sequence > newest_) return true;
  if (newest_ - sequence >= kSize) return false;
  return (taken_[sequence / 64 % kWords] & bitOf(sequence)) == 0;
}

bool ReplayWindow::commit(std::uint64_t sequence) noexcept {
  if (!check(sequence)) return false;
  if (empty_ || sequence > newest_) moveTo(sequence);
  taken_[sequence / 64 % kWords] |= bitOf(sequence);
  return true;
}

void ReplayWindow::moveTo(std::uint64_t newest) noexcept {
  if (empty_ || newest - newest_ >= kSize) {
    taken_.fill(0);
  } else {
    // The numbers in between reuse the bits of those that leave the window.
    for (std::uint64_t n = newest_ + 1; n != newest + 1; ++n) taken_[n / 64 % kWords] &= ~bitOf(n);
  }
  newest_ = newest;
  empty_ = false;
}

}  // namespace tandem
