#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "tandem/coordination/datagram_channel.h"
#include "tandem/plugin/udp_socket.h"

#include "matrix/condition.h"
#include "net/virtual_net.h"

namespace tandem::test {

/// The network between two sites in virtual time: one condition, with an outage.
class MatrixNetwork {
 public:
  MatrixNetwork(const Condition& condition, std::uint64_t seed)
      : cut_(condition.cut), ports_{Port(*this, 0), Port(*this, 1)} {
    conditions_.impairments = condition.network;
    conditions_.impairments.seed = seed;
    conditions_.corrupt = condition.corrupt;
    checkConditions(conditions_);
  }

  /// Blocks all datagrams between these times [s].
  void cutFrom(double from, double until) {
    cut_from_ = from;
    cut_until_ = until;
  }

  /// Hands datagrams due by `now` to `take(site, datagram)`. `now` must not decrease.
  template <typename Take>
  void deliverUntil(double now, Take take) {
    now_ = now;
    if (!isCut()) letGo();
    for (std::size_t from = 0; from < 2; ++from) {
      while (const auto delivery = channels_[from].takeDue(now)) {
        std::array<std::uint8_t, kMaxDatagramSize> bytes;
        std::copy_n(delivery->bytes.data, delivery->bytes.size, bytes.begin());
        take(1 - from, ByteSpan{bytes.data(), delivery->bytes.size});
      }
    }
  }

  [[nodiscard]] net::Outlet& port(std::size_t site) { return ports_[site]; }

 private:
  class Port final : public net::Outlet {
   public:
    Port(MatrixNetwork& owner, std::size_t site) : owner_(owner), site_(site) {}
    void send(ByteView datagram, const Address&) noexcept override {
      owner_.carry(site_, datagram);
    }

   private:
    MatrixNetwork& owner_;
    std::size_t site_;
  };

  [[nodiscard]] bool isCut() const { return now_ >= cut_from_ && now_ < cut_until_; }

  void carry(std::size_t from, ByteView datagram) {
    if (isCut() && cut_ == Cut::kHoldsBack) {
      held_[from].emplace_back(datagram.data, datagram.data + datagram.size);
      return;
    }
    ChannelConditions conditions = conditions_;
    conditions.is_cut = isCut();
    channels_[from].send(datagram, conditions, now_);
  }

  void letGo() {
    for (std::size_t from = 0; from < 2; ++from) {
      for (const auto& bytes : held_[from])
        channels_[from].send({bytes.data(), bytes.size()}, conditions_, now_);
      held_[from].clear();
    }
  }

  /// Capacity for copies under way: five seconds that arrive at once, all doubled.
  static constexpr std::size_t kRoom = 2048;

  Cut cut_;
  ChannelConditions conditions_;
  double now_ = 0.0, cut_from_ = 0.0, cut_until_ = 0.0;
  std::array<DatagramChannel, 2> channels_{
      DatagramChannel(Direction::kForward, kRoom, kMaxDatagramSize),
      DatagramChannel(Direction::kBack, kRoom, kMaxDatagramSize)};
  std::array<std::vector<std::vector<std::uint8_t>>, 2> held_;
  std::array<Port, 2> ports_;
};

}  // namespace tandem::test
