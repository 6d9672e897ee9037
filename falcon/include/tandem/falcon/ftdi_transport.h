#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tandem/falcon/byte_transport.h"

#pragma GCC visibility push(default)
namespace tandem {

/// A device behind an FTDI chip on USB.
struct FtdiAddress {
  int vendor = 0x0403, product = 0xCB48;  ///< of a Novint Falcon
  std::string serial;                     ///< empty: the first there is
};

/// Those plugged in now, with their serial numbers; one that may not be opened has none.
[[nodiscard]] std::vector<FtdiAddress> findFtdi(const FtdiAddress& like = {});

/// Opens it through libftdi1, in user space: no kernel driver, but the right to open the USB
/// device. A tty that ftdi_sio made for it goes away. Reads take one transfer of USB at least,
/// which ends at the latest after the line's latency time, also without a wait. Throws
/// tandem::Error with the remedy if it is not there or cannot be opened.
[[nodiscard]] std::unique_ptr<ByteTransport> openFtdi(const FtdiAddress& address = {});

}  // namespace tandem
#pragma GCC visibility pop
