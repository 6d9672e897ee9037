#pragma once

#include <memory>

#include "tandem/falcon/byte_transport.h"
#include "tandem/falcon/hid_port.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Makes an FT260 a serial line to a Falcon, or to a board that speaks its frames. The UART reaches
/// 12 MBd; a Falcon needs 1.5 MBd. There are no modem control lines and no latency setting. write()
/// may wait as long as the kernel's USB driver does. Throws tandem::Error if the device refuses the
/// settings.
[[nodiscard]] std::unique_ptr<ByteTransport> makeHidUart(std::unique_ptr<HidPort> port);

/// Throws tandem::Error for a bridge that is too slow for a Falcon: a CP2110 reaches only 1 MBd.
void requireFastBridge(const HidAddress& address);

}  // namespace tandem
#pragma GCC visibility pop
