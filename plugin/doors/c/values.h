#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include "tandem/coordination/types.h"
#include "tandem/tandem.h"

// Between the C door's values and ours. All that throw throw std::invalid_argument with the name,
// the value and what is allowed.

namespace tandem::c_door {

/// A pointer that must not be null.
template <typename Value>
Value& checkPointer(Value* pointer, const char* name);

/// "now[3].velocity"; put together only if it is needed.
struct Name {
  Name(const char* whole, std::ptrdiff_t at = -1) : whose(whole), place(at) {}  // NOLINT
  const char* whose;
  std::ptrdiff_t place;  ///< in an array; -1: in none
};

[[noreturn]] void refuseNull(const char* name);
[[noreturn]] void refuseValue(const char* name, double value, const char* allowed);

/// The number in an enumeration that comes from another language, which may be none of it.
template <typename Enumeration>
[[nodiscard]] int readNumber(const Enumeration& enumeration) noexcept {
  int number = 0;
  static_assert(sizeof number == sizeof enumeration);
  std::memcpy(&number, &enumeration, sizeof number);
  return number;
}

void requireFinite(const char* name, double value);
void requirePositive(const char* name, double value);
void requireNotNegative(const char* name, double value);

[[nodiscard]] Vec3 readVec3(const char* name, const double* values);
/// Zero for null.
[[nodiscard]] Vec3 readVec3OrZero(const char* name, const double* values);
/// Of unit length within 1e-6.
[[nodiscard]] Vec3 readUnitVec3(const char* name, const double* values);
[[nodiscard]] RigidState fromC(const Name& name, const TandemState& state);

void writeVec3(const Vec3& v, double* values) noexcept;
/// Lines, as much of them as fits in `room` bytes with the 0; `text` may be null for no room, and
/// `length` anyway.
void writeLines(const std::vector<std::string>& lines, char* text, std::size_t room,
                std::size_t* length);
[[nodiscard]] TandemState toC(const RigidState& state) noexcept;

template <typename Value>
Value& checkPointer(Value* pointer, const char* name) {
  if (!pointer) refuseNull(name);
  return *pointer;
}

}  // namespace tandem::c_door
