#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "tandem/falcon/byte_transport.h"

namespace tandem {

/// Actions that a protocol without I/O requests for its line, in this order: set it, purge it,
/// send. The caller then waits for bytes, at most until `next`.
struct LineStep {
  std::optional<SerialLine> line;
  bool purges = false;
  std::array<std::uint8_t, 64> bytes{};
  std::size_t count = 0;  ///< number of `bytes` to send
  double next = 0.0;      ///< call again at this time, or when bytes have come [s]

  void send(const std::uint8_t* from, std::size_t size) noexcept {
    for (count = 0; count < size && count < bytes.size(); ++count) bytes[count] = from[count];
  }
};

/// Performs the actions. Returns false if the line is gone.
[[nodiscard]] inline bool perform(const LineStep& step, ByteTransport& line) noexcept {
  if (step.line && !line.setLine(*step.line)) return false;
  if (step.purges) line.purge();
  return step.count == 0 || line.write(step.bytes.data(), step.count);
}

}  // namespace tandem
