#include "dds/dds_carrier.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "datagram.h"
#include "dds/participant.h"

namespace tandem {
namespace {

constexpr std::int32_t kNewest = 1;      // best effort never sends one again
constexpr std::int32_t kKept = 64;       // datagrams of a sender until the next poll
constexpr std::size_t kLongest = 1200;   // of datagram.idl [bytes]
constexpr double kLongestWait = 3600.0;  // [s]
constexpr double kNanoseconds = 1e9;     // in a second

std::string topicName(PeerId from, PeerId to) {
  return "tandem_" + std::to_string(static_cast<std::uint32_t>(from)) + "_to_" +
         std::to_string(static_cast<std::uint32_t>(to));
}

struct Way {
  PeerId peer{};
  dds_entity_t writer = 0, reader = 0;
};

}  // namespace

struct DdsCarrier::Impl {
  Impl(int domain, PeerId self, const std::vector<PeerId>& peers) : participant(domain) {
    for (const PeerId peer : peers) addWay(self, peer);
  }

  [[nodiscard]] dds_entity_t makeTopic(PeerId from, PeerId to) const {
    return participant.makeTopic(tandem_dds_Datagram_desc, topicName(from, to).c_str());
  }
  void addWay(PeerId self, PeerId peer);
  [[nodiscard]] static std::optional<std::size_t> take(dds_entity_t reader, ByteSpan room) noexcept;

  dds::Participant participant;
  dds_entity_t waitset = participant.check(dds_create_waitset(participant.entity()));
  std::vector<Way> ways;
  std::size_t next = 0;  ///< whose turn it is, so that no sender holds up another
};

void DdsCarrier::Impl::addWay(PeerId self, PeerId peer) {
  Way way{peer, 0, 0};
  way.writer = participant.makeWriter(makeTopic(self, peer), kNewest);
  way.reader = participant.makeReader(makeTopic(peer, self), kKept);
  const dds_entity_t has_data =
      participant.check(dds_create_readcondition(way.reader, DDS_ANY_STATE));
  (void)participant.check(dds_waitset_attach(waitset, has_data, 0));
  ways.push_back(way);
}

/// Skips samples that only tell of a writer's end.
std::optional<std::size_t> DdsCarrier::Impl::take(dds_entity_t reader, ByteSpan room) noexcept {
  for (;;) {
    void* sample = nullptr;
    dds_sample_info_t info;
    if (dds_take(reader, &sample, &info, 1, 1) <= 0) return std::nullopt;
    std::size_t size = 0;
    if (info.valid_data) {
      const auto& bytes = static_cast<const tandem_dds_Datagram*>(sample)->bytes;
      size = std::min<std::size_t>(bytes._length, room.size);
      if (size > 0) std::memcpy(room.data, bytes._buffer, size);
    }
    (void)dds_return_loan(reader, &sample, 1);
    if (info.valid_data) return size;
  }
}

DdsCarrier::DdsCarrier(int domain, PeerId self, const std::vector<PeerId>& peers)
    : impl_(std::make_unique<Impl>(domain, self, peers)) {}

DdsCarrier::~DdsCarrier() = default;

void DdsCarrier::send(ByteView datagram, PeerId to) noexcept {
  if (datagram.size > kLongest) return;
  tandem_dds_Datagram sample{};
  sample.bytes._length = sample.bytes._maximum = static_cast<std::uint32_t>(datagram.size);
  sample.bytes._buffer = const_cast<std::uint8_t*>(datagram.data);  // Cyclone only reads it
  for (const Way& way : impl_->ways)
    if (way.peer == to) (void)dds_write(way.writer, &sample);
}

std::optional<DatagramCarrier::Received> DdsCarrier::receive(ByteSpan room) noexcept {
  for (std::size_t tried = 0; tried < impl_->ways.size(); ++tried) {
    const Way& way = impl_->ways[impl_->next];
    impl_->next = (impl_->next + 1) % impl_->ways.size();
    if (const auto size = Impl::take(way.reader, room)) return Received{*size, way.peer};
  }
  return std::nullopt;
}

void DdsCarrier::wait(double seconds) const noexcept {
  dds_attach_t found = 0;
  const double most = std::clamp(seconds, 0.0, kLongestWait);
  (void)dds_waitset_wait(impl_->waitset, &found, 1,
                         static_cast<dds_duration_t>(most * kNanoseconds));
}

}  // namespace tandem
