// The work on each datagram in the tick allocates nothing.

#include <array>
#include <cstddef>
#include <cstdint>

#include <gtest/gtest.h>

#include "coordination/src/wire/replay_window.h"
#include "coordination/src/wire/wire_sealing.h"
#include "coordination/src/wire/wire_state.h"
#include "realtime/allocation_count.h"

namespace tandem {
namespace {

TEST(WireAllocation, NoneForAState) {
  StateMessage message;
  message.packet.sender = PeerId{1};
  message.packet.object_count = kMaxObjectsPerPacket;
  for (ObjectId i = 0; i < kMaxObjectsPerPacket; ++i) message.packet.objects[i].id = i;
  ClearHeader header;
  header.session = 1;
  header.sender = PeerId{1};
  header.key_epoch = 1;
  std::array<std::uint8_t, kMaxDatagramSize> datagram{};
  ReplayWindow window;

  const test::AllocationCount count;
  for (std::uint64_t n = 0; n < 3000; ++n) {
    header.sequence = message.packet.sequence = n;
    message.profile = n % 2 == 0 ? WireProfile::kFloat32 : WireProfile::kFloat64;
    const std::size_t head = encodeHeader(header, {datagram.data(), datagram.size()});
    const std::size_t size = encodeState(message, {datagram.data() + head, datagram.size() - head});
    ASSERT_EQ(size, computeStateSize(message.profile, kMaxObjectsPerPacket));

    const ByteView bytes{datagram.data(), head + size};
    const auto got = decodeHeader(bytes);
    ASSERT_TRUE(got && window.check(got->sequence) && window.commit(got->sequence));
    (void)writeAssociatedData(bytes.data, got->sender, PeerId{2});
    (void)writeNonce(computeNonceSalt(got->sender, got->key_epoch), n);
    ASSERT_TRUE(decodeState(payloadOf(bytes), got->sender));
    ASSERT_FALSE(decodeState({bytes.data, size}, got->sender)) << "refused";
  }
  EXPECT_EQ(count.count(), 0U);
}

}  // namespace
}  // namespace tandem
