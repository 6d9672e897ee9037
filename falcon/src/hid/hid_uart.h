#pragma once

#include <memory>

#include "tandem/falcon/byte_transport.h"
#include "tandem/falcon/hid_port.h"

#pragma GCC visibility push(default)
namespace tandem {

/// An FT260 as a serial line, for a Falcon or a board that speaks its frames behind that bridge:
/// its UART runs to 12 MBd, and the Falcon needs 1.5 MBd. It has no modem control lines and no
/// latency to set; write() may wait as long as the kernel's USB driver does. Throws tandem::Error
/// if the device does not take the settings.
[[nodiscard]] std::unique_ptr<ByteTransport> makeHidUart(std::unique_ptr<HidPort> port);

/// Throws tandem::Error for a bridge that cannot carry a Falcon: a CP2110 ends at 1 MBd.
void requireFastBridge(const HidAddress& address);

}  // namespace tandem
#pragma GCC visibility pop
