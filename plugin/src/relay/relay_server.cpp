#include "relay/batch_socket.h"
#include "relay/relay.h"

namespace tandem {
namespace {

/// Most batches per poll, so that a flood cannot keep the caller from its signals.
constexpr int kMostBatches = 64;

}  // namespace

struct RelayServer::Impl {
  Impl(const RelaySettings& settings, SecretKey key)
      : socket(settings.bind), relay(settings, std::move(key), socket) {}

  relay::BatchSocket socket;
  relay::Relay relay;
};

RelayServer::RelayServer(const RelaySettings& settings, SecretKey key)
    : impl_(std::make_unique<Impl>(settings, std::move(key))) {}

RelayServer::~RelayServer() = default;

void RelayServer::poll(double now) noexcept {
  for (int i = 0; i < kMostBatches; ++i) {
    const std::size_t count = impl_->socket.receive();
    for (std::size_t k = 0; k < count; ++k)
      impl_->relay.receive(impl_->socket.datagram(k), impl_->socket.sender(k), now);
    impl_->socket.flush();
    if (count < relay::BatchSocket::kBatch) break;
  }
  impl_->relay.advance(now);
  impl_->socket.flush();
}

void RelayServer::wait(double seconds) const noexcept { impl_->socket.wait(seconds); }

int RelayServer::handle() const noexcept { return impl_->socket.handle(); }

Address RelayServer::bound() const noexcept { return impl_->socket.bound(); }

RelayStatus RelayServer::status() const {
  const relay::RelayCounts& counts = impl_->relay.counts();
  const relay::Members& members = impl_->relay.members();
  RelayStatus status;
  status.forwarded = counts.forwarded;
  status.forwarded_bytes = counts.forwarded_bytes;
  status.unsent = impl_->socket.unsent();
  status.members = static_cast<int>(members.count());
  for (std::size_t i = 0; i < relay::kResults; ++i) {
    const auto result = static_cast<relay::Result>(i);
    status.received += counts.of(result);
    if (result != relay::Result::kTaken && counts.of(result) > 0)
      status.refused.push_back({name(result), counts.of(result)});
  }
  for (const relay::Room& room : members.rooms())
    if (room.count > 0)
      status.rooms.push_back({relay::toString(room.name), room.count, room.watchers, room.forwarded,
                              room.forwarded_bytes, room.too_many});
  return status;
}

}  // namespace tandem
