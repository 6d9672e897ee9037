#pragma once

#include <cstddef>
#include <new>
#include <type_traits>

namespace tandem::secure {

/// Memory for secrets. `is_locked` tells whether the system keeps it out of swap.
struct LockedMemory {
  void* address = nullptr;
  bool is_locked = false;
};

/// Takes memory on its own pages, between guard pages, excluded from core dumps. Also initialises
/// libsodium, so that the owner of a key can use it. Throws std::bad_alloc, or tandem::Error
/// without randomness.
[[nodiscard]] LockedMemory takeLockedMemory(std::size_t size);

/// Wipes and frees the memory; ignores null.
void giveBackLockedMemory(void* address) noexcept;

/// One plain value in locked memory, neither copied nor moved.
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
