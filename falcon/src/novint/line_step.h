#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "tandem/falcon/byte_transport.h"

#pragma GCC visibility push(default)
namespace tandem {

/// What a protocol without I/O wants done with its line now, in this order: set it, forget what has
/// come, send. The caller then waits for bytes, at most until `next`.
struct LineStep {
  std::optional<SerialLine> line;
  bool purges = false;
  std::array<std::uint8_t, 64> bytes{};
  std::size_t count = 0;  ///< of `bytes` to send
  double next = 0.0;      ///< ask again at this time, or when bytes have come [s]

  void send(const std::uint8_t* from, std::size_t size) noexcept {
    for (count = 0; count < size && count < bytes.size(); ++count) bytes[count] = from[count];
  }
};

/// Does it. False: the line is gone.
[[nodiscard]] inline bool perform(const LineStep& step, ByteTransport& line) noexcept {
  if (step.line && !line.setLine(*step.line)) return false;
  if (step.purges) line.purge();
  return step.count == 0 || line.write(step.bytes.data(), step.count);
}

}  // namespace tandem
#pragma GCC visibility pop
