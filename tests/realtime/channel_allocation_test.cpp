// A datagram on an emulated network allocates nothing, whatever its fate.

#include <array>
#include <cstdint>

#include <gtest/gtest.h>

#include "tandem/coordination/link_plan.h"

#include "realtime/allocation_count.h"

namespace tandem {
namespace {

TEST(ChannelAllocation, NoneForADatagram) {
  LinkChange cut;
  cut.at = 2.0;
  cut.cut = LinkCut::kForward;
  LinkChange whole;
  whole.at = 2.5;
  whole.cut = LinkCut::kNone;
  LinkPlan plan({{0.05, 0.04, 0.1, 0.3, 0.1, 7}, 0.1}, {cut, whole});
  DatagramChannel channel(Direction::kForward, 40, 160);  // too few for all datagrams under way
  const std::array<std::uint8_t, 161> bytes{};

  const test::AllocationCount count;
  for (int n = 0; n < 3000; ++n) {
    const double now = 1e-3 * n;
    (void)plan.advance(now);
    while (channel.takeDue(now)) {
    }
    const std::size_t size = n % 10 == 0 ? bytes.size() : 160;
    (void)channel.send({bytes.data(), size}, conditionsOf(plan.settings(), Direction::kForward),
                       now);
  }
  EXPECT_EQ(count.count(), 0U);
  const DatagramChannelCounts& counts = channel.counts();
  EXPECT_GT(counts.delivered, 0U);
  EXPECT_GT(counts.overflowed, 0U);
  EXPECT_GT(counts.cut_off, 0U);
  EXPECT_GT(counts.too_long, 0U);
}

}  // namespace
}  // namespace tandem
