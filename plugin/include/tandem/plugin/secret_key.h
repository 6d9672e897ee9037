#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iosfwd>

#pragma GCC visibility push(default)
namespace tandem {

/// A secret key of 32 bytes. Its memory lies between guard pages and is excluded from core dumps
/// and, if allowed, from swap. It is wiped when the key ends or another key is moved over it. A key
/// can be moved, but never copied or printed.
///
/// Creation, moving over and destruction make system calls: not real-time safe. A key belongs to
/// one thread at a time; several may read it.
class SecretKey {
 public:
  static constexpr std::size_t kSize = 32;

  /// Makes a random key. Throws std::bad_alloc, and tandem::Error if the system gives no
  /// randomness.
  [[nodiscard]] static SecretKey generate();

  /// Moves the key out of `bytes` and wipes `bytes`, also if it throws. Throws as generate().
  [[nodiscard]] static SecretKey take(std::array<std::uint8_t, kSize>& bytes);

  ~SecretKey();
  SecretKey(SecretKey&& other) noexcept;  ///< leaves `other` empty
  SecretKey& operator=(SecretKey&& other) noexcept;
  SecretKey(const SecretKey&) = delete;
  SecretKey& operator=(const SecretKey&) = delete;

  /// The kSize bytes, valid during the key's life; null after the key was moved away.
  [[nodiscard]] const std::uint8_t* data() const noexcept { return bytes_; }
  [[nodiscard]] bool isEmpty() const noexcept { return bytes_ == nullptr; }

  /// True if the system keeps the key out of swap. If not, raise the limit of locked memory
  /// (`ulimit -l`); the key works all the same.
  [[nodiscard]] bool isLocked() const noexcept { return is_locked_; }

  /// Compares two keys in a time that does not depend on where they differ.
  [[nodiscard]] bool equals(const SecretKey& other) const noexcept;

  friend std::ostream& operator<<(std::ostream&, const SecretKey&) = delete;

 private:
  SecretKey();

  std::uint8_t* bytes_;
  bool is_locked_;
};

}  // namespace tandem
#pragma GCC visibility pop
