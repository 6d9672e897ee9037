#pragma once

#include <memory>

#include "tandem/plugin/udp_socket.h"

namespace tandem::relay {

/// A UDP socket that takes and gives datagrams in batches: one system call for up to kBatch.
class BatchSocket final : public net::Outlet {
 public:
  static constexpr std::size_t kBatch = 64;

  /// Throws as UdpSocket does.
  explicit BatchSocket(const Address& bind);
  ~BatchSocket() override;

  /// Takes what is there, at most kBatch. Returns the number.
  [[nodiscard]] std::size_t receive() noexcept;
  /// Bytes of a datagram of the last receive(). One that is too long is cut.
  [[nodiscard]] ByteSpan datagram(std::size_t index) noexcept;
  [[nodiscard]] Address sender(std::size_t index) const noexcept;

  /// Copies the datagram, and sends it with a full batch or by flush().
  void send(ByteView datagram, const Address& to) noexcept override;
  void flush() noexcept;

  void wait(double seconds) const noexcept { socket_.wait(seconds); }
  [[nodiscard]] int handle() const noexcept { return socket_.handle(); }
  [[nodiscard]] Address bound() const noexcept { return socket_.bound(); }
  [[nodiscard]] std::uint64_t unsent() const noexcept { return unsent_; }

 private:
  struct Batch;

  net::UdpSocket socket_;
  std::unique_ptr<Batch> incoming_, outgoing_;
  std::size_t waiting_ = 0;  ///< in `outgoing_`
  std::uint64_t unsent_ = 0;
};

}  // namespace tandem::relay
