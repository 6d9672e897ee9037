#include "relay/batch_socket.h"

#include <array>
#include <cerrno>
#include <cstring>

#include "net/system_address.h"
#include "relay/relay_wire.h"

namespace tandem::relay {
namespace {

/// Room for a burst of all members of a full room: 64 * 63 datagrams with the system's overhead
/// [bytes].
constexpr int kBufferSize = 8 * 1024 * 1024;

/// Beyond the system's usual limit only root may go.
void setBuffer(int socket, int forced, int usual) noexcept {
  if (setsockopt(socket, SOL_SOCKET, forced, &kBufferSize, sizeof kBufferSize) != 0)
    (void)setsockopt(socket, SOL_SOCKET, usual, &kBufferSize, sizeof kBufferSize);
}

}  // namespace

/// Datagrams in the form of the system's calls.
struct BatchSocket::Batch {
  static constexpr std::size_t kRoom = kMaxForward + 1;  ///< one byte more reveals a longer one

  Batch() noexcept {
    for (std::size_t i = 0; i < kBatch; ++i) {
      pieces[i] = {bytes[i].data(), kRoom};
      headers[i].msg_hdr.msg_iov = &pieces[i];
      headers[i].msg_hdr.msg_iovlen = 1;
      headers[i].msg_hdr.msg_name = &addresses[i].storage;
    }
  }

  std::array<std::array<std::uint8_t, kRoom>, kBatch> bytes;
  std::array<net::SystemAddress, kBatch> addresses;
  std::array<iovec, kBatch> pieces;
  std::array<mmsghdr, kBatch> headers{};
};

BatchSocket::BatchSocket(const Address& bind)
    : socket_(bind), incoming_(std::make_unique<Batch>()), outgoing_(std::make_unique<Batch>()) {
  setBuffer(socket_.handle(), SO_RCVBUFFORCE, SO_RCVBUF);
  setBuffer(socket_.handle(), SO_SNDBUFFORCE, SO_SNDBUF);
}

BatchSocket::~BatchSocket() = default;

std::size_t BatchSocket::receive() noexcept {
  for (mmsghdr& header : incoming_->headers) header.msg_hdr.msg_namelen = sizeof(sockaddr_storage);
  // An error of an earlier send (no such port) does not concern the waiting datagrams.
  for (int tries = 0; tries < 8; ++tries) {
    const int got = ::recvmmsg(socket_.handle(), incoming_->headers.data(), kBatch, 0, nullptr);
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno == EAGAIN || errno == EWOULDBLOCK) return 0;
  }
  return 0;
}

ByteSpan BatchSocket::datagram(std::size_t index) noexcept {
  return {incoming_->bytes[index].data(), incoming_->headers[index].msg_len};
}

Address BatchSocket::sender(std::size_t index) const noexcept {
  return net::fromSystem(incoming_->addresses[index].storage);
}

void BatchSocket::send(ByteView datagram, const Address& to) noexcept {
  if (datagram.size > Batch::kRoom || (socket_.isIpv4() && !net::isMappedIpv4(to))) {
    ++unsent_;
    return;
  }
  if (waiting_ == kBatch) flush();
  std::memcpy(outgoing_->bytes[waiting_].data(), datagram.data, datagram.size);
  outgoing_->pieces[waiting_].iov_len = datagram.size;
  net::SystemAddress& address = outgoing_->addresses[waiting_];
  address = net::toSystem(to, socket_.isIpv4());
  outgoing_->headers[waiting_].msg_hdr.msg_namelen = address.size;
  ++waiting_;
}

void BatchSocket::flush() noexcept {
  std::size_t sent = 0;
  while (sent < waiting_) {
    const int count = ::sendmmsg(socket_.handle(), outgoing_->headers.data() + sent,
                                 static_cast<unsigned>(waiting_ - sent), 0);
    if (count > 0) {
      sent += static_cast<std::size_t>(count);
    } else {  // this one cannot be sent: it is lost, as on any network
      ++sent;
      ++unsent_;
    }
  }
  waiting_ = 0;
}

}  // namespace tandem::relay
