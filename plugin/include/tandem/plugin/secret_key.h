#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iosfwd>

#pragma GCC visibility push(default)
namespace tandem {

/// 32 secret bytes. They live in memory of their own that is kept out of swap and core dumps,
/// between guard pages, and are wiped when the key ends or another is moved over it. A key moves
/// and is never copied or printed.
///
/// Making, moving over and ending a key call the system: not real-time safe. A key belongs to one
/// thread at a time; reading it from several is safe.
class SecretKey {
 public:
  static constexpr std::size_t kSize = 32;

  /// Random, from the system. Throws std::bad_alloc, and tandem::Error if there is no randomness.
  [[nodiscard]] static SecretKey generate();

  /// Takes over what `bytes` holds and wipes `bytes`. Throws as generate(), with `bytes` wiped,
  /// too.
  [[nodiscard]] static SecretKey take(std::array<std::uint8_t, kSize>& bytes);

  ~SecretKey();
  SecretKey(SecretKey&& other) noexcept;  ///< leaves `other` empty
  SecretKey& operator=(SecretKey&& other) noexcept;
  SecretKey(const SecretKey&) = delete;
  SecretKey& operator=(const SecretKey&) = delete;

  /// The kSize bytes, for as long as the key lives; null if it was moved away.
  [[nodiscard]] const std::uint8_t* data() const noexcept { return bytes_; }
  [[nodiscard]] bool isEmpty() const noexcept { return bytes_ == nullptr; }

  /// Whether the system promised to keep it out of swap. If not, raise the limit of locked memory
  /// (`ulimit -l`); the key works all the same.
  [[nodiscard]] bool isLocked() const noexcept { return is_locked_; }

  /// Whether two keys are the same, in a time that does not depend on where they differ.
  [[nodiscard]] bool equals(const SecretKey& other) const noexcept;

  friend std::ostream& operator<<(std::ostream&, const SecretKey&) = delete;

 private:
  SecretKey();

  std::uint8_t* bytes_;
  bool is_locked_;
};

}  // namespace tandem
#pragma GCC visibility pop
