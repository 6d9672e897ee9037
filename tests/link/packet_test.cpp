#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/coordination/link.h"

namespace tandem {
namespace {

const std::vector<double> kNotFinite = {std::nan(""), std::numeric_limits<double>::infinity(),
                                        -std::numeric_limits<double>::infinity()};

StatePacket makeFullPacket() {
  StatePacket packet;
  packet.sender = PeerId{1};
  packet.sequence = 42;
  packet.time = 3.5;  // [s]
  packet.user = {Vec3(0.1, 0.2, 0.3), Vec3(-1.0, 0.0, 1.0)};
  packet.object_count = kMaxObjectsPerPacket;
  ObjectId id = 0;
  for (ObjectState& object : packet.objects) {
    object.id = id++;
    object.state.p_W = Vec3(1.0, -2.0, 3.0);
    object.state.q_WB = Quat(0.5, -0.5, 0.5, 0.5);
    object.state.v_W = Vec3(0.1, 0.1, 0.1);
    object.state.w_W = Vec3(10.0, 0.0, -10.0);
  }
  return packet;
}

/// Pointers to every number of a full packet.
std::vector<double*> listNumbers(StatePacket& packet) {
  std::vector<double*> numbers = {&packet.time};
  const auto add = [&numbers](auto& coefficients) {
    for (double& c : coefficients.reshaped()) numbers.push_back(&c);
  };
  add(packet.user.p_W);
  add(packet.user.v_W);
  for (ObjectState& object : packet.objects) {
    add(object.state.p_W);
    add(object.state.q_WB.coeffs());
    add(object.state.v_W);
    add(object.state.w_W);
  }
  return numbers;
}

TEST(Packet, FreshAndFullOnesAreSane) {
  EXPECT_TRUE(isSane(StatePacket{}));
  EXPECT_TRUE(isSane(makeFullPacket()));
}

TEST(Packet, EachNumberMustBeFinite) {
  StatePacket packet = makeFullPacket();
  const std::vector<double*> numbers = listNumbers(packet);
  ASSERT_EQ(numbers.size(), 1U + 6U + 13U * kMaxObjectsPerPacket);
  for (double* number : numbers) {
    const double good = *number;
    for (const double bad : kNotFinite) {
      *number = bad;
      EXPECT_FALSE(isSane(packet)) << "number " << number - numbers.front() << " = " << bad;
    }
    *number = good;
  }
  EXPECT_TRUE(isSane(packet));
}

TEST(Packet, CarriesNoMoreObjectsThanFit) {
  StatePacket packet = makeFullPacket();
  for (const std::uint32_t count : {9U, 1000U, std::numeric_limits<std::uint32_t>::max()}) {
    packet.object_count = count;
    EXPECT_FALSE(isSane(packet)) << count;
  }
}

TEST(Packet, QuaternionMustBeOfUnitLength) {
  for (const int index : {0, kMaxObjectsPerPacket - 1}) {
    for (const double length : {1.0 - 9e-7, 1.0 + 9e-7}) {
      StatePacket packet = makeFullPacket();
      packet.objects[static_cast<std::size_t>(index)].state.q_WB.coeffs() *= length;
      EXPECT_TRUE(isSane(packet)) << length;
    }
    for (const double length : {0.0, 1e-200, 0.5, 1.0 - 1.1e-6, 1.0 + 1.1e-6, 2.0, 1e200}) {
      StatePacket packet = makeFullPacket();
      packet.objects[static_cast<std::size_t>(index)].state.q_WB.coeffs() *= length;
      EXPECT_FALSE(isSane(packet)) << length;
    }
  }
}

TEST(Packet, EntriesBeyondTheCountAreNoPartOfIt) {
  StatePacket packet = makeFullPacket();
  packet.object_count = 3;
  packet.objects[3].state.p_W.x() = std::nan("");
  packet.objects[4].state.q_WB.coeffs().setZero();
  EXPECT_TRUE(isSane(packet));
  packet.object_count = 4;
  EXPECT_FALSE(isSane(packet));
}

TEST(ObjectEpoch, IsOrderedTheSameEverywhere) {
  const ObjectEpoch none, first{1, PeerId{1}}, rival{1, PeerId{2}}, second{2, PeerId{1}};
  EXPECT_TRUE(isNewer(first, none));
  EXPECT_TRUE(isNewer(rival, first));
  EXPECT_TRUE(isNewer(second, rival));
  for (const auto& [older, newer] : {std::pair{none, first}, {first, rival}, {rival, second}})
    EXPECT_FALSE(isNewer(older, newer));
  EXPECT_FALSE(isNewer(first, first));
}

TEST(ObjectEpoch, CountsOnBehindItsLargestNumber) {
  const ObjectEpoch last{~std::uint32_t{0}, PeerId{3}};
  const ObjectEpoch next = beginEpoch(last, PeerId{1});
  EXPECT_EQ(next.count, 1u);  // 0 stands for none
  EXPECT_TRUE(isNewer(next, last));
  EXPECT_FALSE(isNewer(last, next));
  EXPECT_TRUE(isNewer(last, ObjectEpoch{}));
}

}  // namespace
}  // namespace tandem
