#pragma once

#include <cstddef>
#include <new>
#include <type_traits>

namespace tandem::secure {

/// Memory for secrets, and whether the system promised to keep it out of swap.
struct LockedMemory {
  void* address = nullptr;
  bool is_locked = false;
};

/// Memory of its own pages, between guard pages, out of core dumps. Also makes libsodium ready, so
/// that whoever holds a key may call it. Throws std::bad_alloc; tandem::Error without randomness.
[[nodiscard]] LockedMemory takeLockedMemory(std::size_t size);

/// Wipes it and gives it back; null is fine.
void giveBackLockedMemory(void* address) noexcept;

/// One plain value in such memory, neither copied nor moved.
template <typename Value>
class LockedBox {
  static_assert(std::is_trivially_copyable_v<Value> && std::is_trivially_destructible_v<Value>);
  static_assert(alignof(Value) <= 16);

 public:
  LockedBox() : value_(new (takeLockedMemory(sizeof(Value)).address) Value{}) {}
  ~LockedBox() { giveBackLockedMemory(value_); }
  LockedBox(const LockedBox&) = delete;
  LockedBox& operator=(const LockedBox&) = delete;

  [[nodiscard]] Value& operator*() const noexcept { return *value_; }
  [[nodiscard]] Value* operator->() const noexcept { return value_; }

 private:
  Value* value_;
};

}  // namespace tandem::secure
