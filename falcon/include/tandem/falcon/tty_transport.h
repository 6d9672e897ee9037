#pragma once

#include <memory>
#include <string>

#include "tandem/falcon/byte_transport.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Opens a serial line of the kernel, such as /dev/ttyUSB0 or a pseudo terminal, for this program
/// alone. Any speed is set (termios2); DTR, RTS and the latency time are left out where the line
/// has none. Throws tandem::Error with the remedy if it cannot be opened. Linux.
[[nodiscard]] std::unique_ptr<ByteTransport> openTty(const std::string& path);

}  // namespace tandem
#pragma GCC visibility pop
