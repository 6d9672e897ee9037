#pragma once

#include "tandem/coordination/datagram.h"
#include "tandem/plugin/address.h"

#pragma GCC visibility push(default)
namespace tandem::net {

/// Takes datagrams that are to be sent: a socket, or a simulated network.
class Outlet {
 public:
  virtual ~Outlet() = default;
  /// Never blocks; what cannot be sent is lost, as on any network.
  virtual void send(ByteView datagram, const Address& to) noexcept = 0;
};

}  // namespace tandem::net
#pragma GCC visibility pop
