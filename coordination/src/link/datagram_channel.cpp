#include "tandem/coordination/datagram_channel.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "bad_value.h"
#include "link/flight_queue.h"

// clang-format off
//   send(datagram, conditions, now)                                    takeDue(now)
//        |                                                                  ^
//   cut? too long? lost? ----> launch: first copy, maybe corrupted --+      | due <= now
//        |                                                           v      |
//        +-------------------> launch: duplicate, maybe corrupted --> heap of copies under way
// clang-format on

namespace tandem {

struct DatagramChannel::Impl {
  /// Record of one copy under way.
  struct Cargo {
    std::size_t size = 0;
    std::uint64_t number = 0;
    double delay = 0.0, jitter = 0.0;  // [s]
    bool is_reordered = false;
    bool is_duplicate = false;
  };

  Impl(Direction of, std::size_t capacity, std::size_t longest_datagram)
      : direction(of),
        longest(longest_datagram),
        queue(capacity),
        cargo(capacity),
        bytes(capacity * longest_datagram) {}

  void launch(ByteView datagram, const ChannelConditions& conditions, const Cargo& kind, double now,
              double delay) noexcept {
    double due = now + delay;
    if (conditions.keep_order && !kind.is_reordered) due = std::max(due, latest_due);
    const auto slot = queue.launch(now, due);
    if (!slot) {
      ++counts.overflowed;
      return;
    }
    if (!kind.is_reordered) latest_due = std::max(latest_due, due);
    cargo[*slot] = kind;
    std::uint8_t* room = bytes.data() + *slot * longest;
    std::copy_n(datagram.data, datagram.size, room);
    const auto bit =
        computeCorruptBit(conditions.corrupt, conditions.impairments.seed, direction, kind.number,
                          kind.is_duplicate ? Copy::kDuplicate : Copy::kFirst, datagram.size);
    if (bit) {
      room[*bit / 8] = static_cast<std::uint8_t>(room[*bit / 8] ^ (1U << (*bit % 8)));
      ++counts.corrupted;
    }
  }

  Direction direction;
  std::size_t longest;
  FlightQueue queue;
  std::vector<Cargo> cargo;         // by slot
  std::vector<std::uint8_t> bytes;  // by slot, `longest` for each
  std::optional<std::size_t> lent;  // slot of the last delivery
  double latest_due = 0.0;          // of copies that were not reordered [s]
  std::uint64_t highest = 0;        // highest delivered number + 1
  DatagramChannelCounts counts;
};

DatagramChannel::DatagramChannel(Direction direction, std::size_t capacity, std::size_t longest) {
  if (capacity == 0) throwBadValue("channel capacity", capacity, "at least 1 datagram");
  if (longest == 0) throwBadValue("longest datagram", longest, "at least 1 byte");
  impl_ = std::make_unique<Impl>(direction, capacity, longest);
}

DatagramChannel::~DatagramChannel() = default;
DatagramChannel::DatagramChannel(DatagramChannel&&) noexcept = default;
DatagramChannel& DatagramChannel::operator=(DatagramChannel&&) noexcept = default;

Entrance DatagramChannel::send(ByteView datagram, const ChannelConditions& conditions,
                               double now) noexcept {
  DatagramChannelCounts& counts = impl_->counts;
  Impl::Cargo kind;
  kind.size = datagram.size;
  kind.number = counts.sent++;
  if (conditions.is_cut) {
    ++counts.cut_off;
    return Entrance::kCutOff;
  }
  if (datagram.size > impl_->longest) {
    ++counts.too_long;
    return Entrance::kTooLong;
  }
  const PacketFate fate = computeFate(conditions.impairments, impl_->direction, kind.number);
  if (fate.is_lost) {
    ++counts.lost;
    return Entrance::kLost;
  }
  kind.delay = conditions.impairments.delay;
  kind.jitter = conditions.impairments.jitter;
  kind.is_reordered = fate.is_reordered;
  if (fate.is_reordered) ++counts.reordered;
  impl_->launch(datagram, conditions, kind, now, fate.delay);
  if (fate.is_duplicated) {
    ++counts.duplicated;
    kind.is_reordered = false;
    kind.is_duplicate = true;
    impl_->launch(datagram, conditions, kind, now, fate.duplicate_delay);
  }
  return Entrance::kOnItsWay;
}

double DatagramChannel::nextDue() const noexcept {
  return impl_->queue.isEmpty() ? std::numeric_limits<double>::infinity()
                                : impl_->queue.earliest().arrival;
}

std::optional<Delivery> DatagramChannel::takeDue(double now) noexcept {
  if (impl_->lent) impl_->queue.release(*impl_->lent);
  impl_->lent.reset();
  if (!(nextDue() <= now)) return std::nullopt;
  const FlightQueue::Flight flight = impl_->queue.takeEarliest();
  const Impl::Cargo& cargo = impl_->cargo[flight.slot];
  impl_->lent = flight.slot;
  ++impl_->counts.delivered;
  if (!cargo.is_duplicate && cargo.number < impl_->highest) ++impl_->counts.overtaken;
  impl_->highest = std::max(impl_->highest, cargo.number + 1);
  return Delivery{{impl_->bytes.data() + flight.slot * impl_->longest, cargo.size},
                  flight.sent,
                  flight.arrival,
                  cargo.delay,
                  cargo.jitter,
                  cargo.is_reordered};
}

const DatagramChannelCounts& DatagramChannel::counts() const noexcept { return impl_->counts; }

void checkConditions(const ChannelConditions& conditions) {
  checkImpairments(conditions.impairments);
  if (!(conditions.corrupt >= 0.0 && conditions.corrupt <= 1.0))
    throwBadValue("network corrupt", conditions.corrupt, "a probability from 0 to 1");
}

}  // namespace tandem
