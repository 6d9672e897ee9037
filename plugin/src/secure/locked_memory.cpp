#include "secure/locked_memory.h"

#include <sodium.h>

#include "tandem/coordination/types.h"

namespace tandem::secure {
namespace {

void requireSodium() {
  static const bool is_ready = sodium_init() >= 0;
  if (!is_ready)
    throw Error("libsodium finds no source of randomness; is /dev/urandom there and readable?");
}

}  // namespace

LockedMemory takeLockedMemory(std::size_t size) {
  requireSodium();
  void* address = sodium_malloc(size);
  if (address == nullptr) throw std::bad_alloc();
  // sodium_malloc() tries to lock the memory but does not report it. A second lock costs nothing.
  return {address, sodium_mlock(address, size) == 0};
}

void giveBackLockedMemory(void* address) noexcept { sodium_free(address); }

}  // namespace tandem::secure
