#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include "tandem/coordination/types.h"
#include "tandem/tandem.h"

// Conversion and checks of the C interface's values. Functions throw std::invalid_argument with the
// name, the value and what is allowed.

namespace tandem::c_door {

/// Checks that a pointer is not null.
template <typename Value>
Value& checkPointer(Value* pointer, const char* name);

/// Parts of a name such as "now[3].velocity", joined only for a message.
struct Name {
  Name(const char* whole, std::ptrdiff_t at = -1) : whose(whole), place(at) {}  // NOLINT
  const char* whose;
  std::ptrdiff_t place;  ///< index in an array; -1: no array
};

[[noreturn]] void refuseNull(const char* name);
[[noreturn]] void refuseValue(const char* name, double value, const char* allowed);

/// Number of an enumeration value from another language, which may be invalid.
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
/// Returns zero for null.
[[nodiscard]] Vec3 readVec3OrZero(const char* name, const double* values);
/// The length must be 1 within 1e-6.
[[nodiscard]] Vec3 readUnitVec3(const char* name, const double* values);
/// x, y, z, w; the length must be 1 within 1e-6.
[[nodiscard]] Quat readOrientation(const char* name, const double* values);
[[nodiscard]] RigidState fromC(const Name& name, const TandemState& state);

void writeVec3(const Vec3& v, double* values) noexcept;
/// Writes as many lines as fit in `room` bytes with the final 0. `text` may be null if `room` is 0;
/// `length` may always be null.
void writeLines(const std::vector<std::string>& lines, char* text, std::size_t room,
                std::size_t* length);
[[nodiscard]] TandemState toC(const RigidState& state) noexcept;

template <typename Value>
Value& checkPointer(Value* pointer, const char* name) {
  if (!pointer) refuseNull(name);
  return *pointer;
}

}  // namespace tandem::c_door
