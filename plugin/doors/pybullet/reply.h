#pragma once

#include <string>

#include "tandem/tandem.h"

#include "b3_abi.h"

namespace tandem::pybullet {

/// Reply of a command: a number, negative if it was refused, and bytes. The bytes are the text of
/// an error or a warning, or doubles.
struct Reply {
  int status = 0;
  int type = b3::kBytes;
  std::string bytes;

  void putText(const std::string& text) {
    type = b3::kString;
    bytes = text;
  }
  void put(const double* values, std::size_t size) {
    bytes.append(reinterpret_cast<const char*>(values), size * sizeof(double));
  }
  void put(double value) { put(&value, 1); }
  void put(const TandemState& state) {
    put(state.position, 3);
    put(state.orientation, 4);
    put(state.velocity, 3);
    put(state.angular_velocity, 3);
  }
};

}  // namespace tandem::pybullet
