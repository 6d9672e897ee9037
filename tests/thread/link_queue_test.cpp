#include "tandem/plugin/link_queue.h"

#include <thread>

#include <gtest/gtest.h>

#include "support/fakes.h"

namespace tandem {
namespace {

using test::FakeLink;
using test::makePacket;

TEST(LinkQueue, SendsInOrderWithTheirTimes) {
  LinkQueue queue;
  FakeLink wire(8);
  for (std::uint64_t i = 0; i < 3; ++i) queue.send(makePacket(PeerId{1}, i, Vec3::Zero()), 0.1);
  EXPECT_TRUE(wire.sent.empty());
  queue.exchange(wire, 0.1, 0.102);
  ASSERT_EQ(wire.sent.size(), 3u);
  for (std::uint64_t i = 0; i < 3; ++i) EXPECT_EQ(wire.sent[i].sequence, i);
}

TEST(LinkQueue, GivesArrivalsToTheirTick) {
  LinkQueue queue;
  FakeLink wire;
  wire.arrivals.push_back({makePacket(PeerId{2}, 0, Vec3::Zero()), 0.0995});
  wire.arrivals.push_back({makePacket(PeerId{2}, 1, Vec3::Zero()), 0.1005});
  queue.exchange(wire, 0.099, 0.101);
  EXPECT_FALSE(queue.receive(0.098, 0.099)) << "it is still to come";
  const auto inside = queue.receive(0.099, 0.100);
  ASSERT_TRUE(inside);
  EXPECT_EQ(inside->time, 0.0995);
  const auto late = queue.receive(0.2, 0.201);
  ASSERT_TRUE(late);
  EXPECT_EQ(late->packet.sequence, 1u);
  EXPECT_EQ(late->time, 0.2) << "what was there before counts from the tick on";
  EXPECT_FALSE(queue.receive(0.2, 0.201));
}

TEST(LinkQueue, CountsWhatFindsNoRoom) {
  LinkQueue queue;
  const StatePacket packet = makePacket(PeerId{1}, 0, Vec3::Zero());
  std::uint64_t sent = 0;
  for (; queue.lost() == 0; ++sent) queue.send(packet, 0.0);
  FakeLink wire(2 * sent);
  queue.exchange(wire, 0.0, 0.0);
  EXPECT_EQ(wire.sent.size(), sent - 1);
}

TEST(LinkQueue, KeepsOrderBetweenTwoThreads) {
  constexpr std::uint64_t kPackets = 20'000;
  LinkQueue queue;
  std::uint64_t received = 0, last = 0;
  bool in_order = true, saw_last = false;
  std::thread site([&] {
    while (!saw_last) {
      const auto arrival = queue.receive(1.0, 2.0);
      if (!arrival) continue;
      in_order &= received == 0 || arrival->packet.sequence > last;
      last = arrival->packet.sequence;
      saw_last = last >= kPackets;
      ++received;
    }
  });
  FakeLink wire;
  std::uint64_t sent = 0;
  const auto put = [&] {
    wire.arrivals.push_back({makePacket(PeerId{2}, sent++, Vec3::Zero()), 1.0});
    queue.exchange(wire, 1.0, 2.0);
  };
  while (sent < kPackets) put();
  // Items may be lost when the queue is full; the last one must not be.
  for (std::uint64_t before = queue.lost();; before = queue.lost()) {
    put();
    if (queue.lost() == before) break;
    std::this_thread::yield();
  }
  site.join();
  EXPECT_TRUE(in_order);
  EXPECT_EQ(received + queue.lost(), sent);
}

}  // namespace
}  // namespace tandem
