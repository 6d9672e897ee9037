#include "tandem/plugin/secret_key.h"

#include <utility>

#include <sodium.h>

#include "secure/locked_memory.h"

namespace tandem {

SecretKey::SecretKey() {
  const secure::LockedMemory memory = secure::takeLockedMemory(kSize);
  bytes_ = static_cast<std::uint8_t*>(memory.address);
  is_locked_ = memory.is_locked;
}

SecretKey SecretKey::generate() {
  SecretKey key;
  randombytes_buf(key.bytes_, kSize);
  return key;
}

SecretKey SecretKey::take(std::array<std::uint8_t, kSize>& bytes) {
  struct Wipe {
    std::array<std::uint8_t, kSize>& bytes;
    ~Wipe() { sodium_memzero(bytes.data(), kSize); }
  } const wipe{bytes};
  SecretKey key;
  for (std::size_t i = 0; i < kSize; ++i) key.bytes_[i] = bytes[i];
  return key;
}

SecretKey::~SecretKey() { secure::giveBackLockedMemory(bytes_); }

SecretKey::SecretKey(SecretKey&& other) noexcept
    : bytes_(std::exchange(other.bytes_, nullptr)),
      is_locked_(std::exchange(other.is_locked_, false)) {}

SecretKey& SecretKey::operator=(SecretKey&& other) noexcept {
  if (this == &other) return *this;
  secure::giveBackLockedMemory(std::exchange(bytes_, std::exchange(other.bytes_, nullptr)));
  is_locked_ = std::exchange(other.is_locked_, false);
  return *this;
}

bool SecretKey::equals(const SecretKey& other) const noexcept {
  if (isEmpty() || other.isEmpty()) return false;
  return sodium_memcmp(bytes_, other.bytes_, kSize) == 0;
}

}  // namespace tandem
