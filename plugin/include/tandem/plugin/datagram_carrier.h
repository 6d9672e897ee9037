#pragma once

#include <optional>

#include "tandem/coordination/datagram.h"
#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Another way for sealed datagrams than UDP, such as a laboratory's own bus. A mesh seals, checks
/// and times datagrams; a carrier only moves bytes, and nobody trusts what it delivers.
///
/// send() and receive() are for the thread that polls the mesh, which is a site's own if it has no
/// other. They must not block, throw or wait for a lock that another thread holds for long. wait()
/// may run at the same time as status calls of the mesh.
class DatagramCarrier {
 public:
  virtual ~DatagramCarrier() = default;

  /// Sends at most 1200 bytes to a site. What cannot be sent at once is lost.
  virtual void send(ByteView datagram, PeerId to) noexcept = 0;

  struct Received {
    std::size_t size = 0;  ///< [bytes]
    PeerId from{};         ///< the claimed sender: not authentic
  };
  /// Takes the next datagram; empty if there is none. Cuts one longer than `room`. A burst of 32
  /// datagrams of a sender must arrive whole: a handshake and states do not replace each other.
  [[nodiscard]] virtual std::optional<Received> receive(ByteSpan room) noexcept = 0;

  /// Waits for a datagram, at most `seconds`.
  virtual void wait(double seconds) const noexcept = 0;
};

}  // namespace tandem
#pragma GCC visibility pop
