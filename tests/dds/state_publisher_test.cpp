// What a site publishes arrives as it was, at readers as Cyclone's own documents write them.

#include "dds/state_publisher.h"

#include <cmath>
#include <optional>
#include <stdexcept>

#include <gtest/gtest.h>

#include "dds/dds_pair.h"
#include "dds/participant.h"
#include "states.h"

namespace tandem {
namespace {

/// A laboratory's reader of one topic.
template <typename Sample>
class Reader {
 public:
  Reader(int domain, const dds_topic_descriptor_t& type, const char* name) : member_(domain) {
    reader_ = dds_create_reader(member_.entity(), member_.makeTopic(type, name), nullptr, nullptr);
  }
  [[nodiscard]] std::optional<Sample> take() {
    void* sample = nullptr;
    dds_sample_info_t info;
    std::optional<Sample> taken;
    if (dds_take(reader_, &sample, &info, 1, 1) <= 0) return taken;
    if (info.valid_data) taken = *static_cast<const Sample*>(sample);
    state_ = info.instance_state;
    (void)dds_return_loan(reader_, &sample, 1);
    return taken;
  }
  /// Of what was taken last.
  [[nodiscard]] dds_instance_state_t state() const { return state_; }

 private:
  dds::Participant member_;
  dds_entity_t reader_ = 0;
  dds_instance_state_t state_ = DDS_IST_ALIVE;
};

using Hands = Reader<tandem_dds_HandState>;
using Objects = Reader<tandem_dds_ObjectState>;

SiteStates makeStates() {
  SiteStates states{PeerId{3}, 41, 0.25, {{1.0, -2.0, 0.1}, {0.5, 0.0, 1e-9}}, Vec3(5, 6, 7), {}};
  for (const ObjectId id : {0u, 2u})
    states.objects.push_back(
        {id, {Vec3(id, 0.2, 0.3), Quat(0.5, -0.5, 0.5, 0.5), Vec3(4, 5, 6), Vec3(7, 8, 9)}});
  return states;
}

Vec3 toVec3(const tandem_dds_Vector& v) { return {v.x, v.y, v.z}; }

/// Publishes until a reader has got it: it must have found the publisher.
template <typename Sample>
Sample publishUntilTaken(StatePublisher& publisher, const SiteStates& states,
                         Reader<Sample>& reader) {
  for (const double end = test::clockNow() + test::kPatience; test::clockNow() < end;) {
    publisher.publish(states);
    if (const auto taken = reader.take()) return *taken;
    dds_sleepfor(DDS_MSECS(1));
  }
  ADD_FAILURE() << "nothing came";
  return {};
}

TEST(StatePublisher, AHandArrivesAsItWas) {
  const int domain = test::openLoopbackDomain();
  Hands hands(domain, tandem_dds_HandState_desc, "tandem/hands");
  StatePublisher publisher(domain);
  SiteStates states = makeStates();
  const tandem_dds_HandState hand = publishUntilTaken(publisher, states, hands);
  EXPECT_EQ(hand.site, 3u);
  EXPECT_EQ(hand.tick, 41u);
  EXPECT_EQ(hand.time, 0.25);
  EXPECT_EQ(toVec3(hand.position), states.hand.p_W);
  EXPECT_EQ(toVec3(hand.velocity), states.hand.v_W);
  EXPECT_EQ(toVec3(hand.force), *states.force_W);
}

TEST(StatePublisher, AForceThatNobodyKnowsIsNoNumber) {
  const int domain = test::openLoopbackDomain();
  Hands hands(domain, tandem_dds_HandState_desc, "tandem/hands");
  StatePublisher publisher(domain);
  SiteStates states = makeStates();
  states.force_W.reset();
  EXPECT_TRUE(std::isnan(publishUntilTaken(publisher, states, hands).force.x));
}

// One sample of history each: the objects are instances of their own, and none replaces another.
TEST(StatePublisher, ObjectsDoNotReplaceEachOther) {
  const int domain = test::openLoopbackDomain();
  Objects objects(domain, tandem_dds_ObjectState_desc, "tandem/objects");
  StatePublisher publisher(domain);
  const SiteStates states = makeStates();
  std::optional<tandem_dds_ObjectState> second;
  for (const double end = test::clockNow() + test::kPatience; !second && test::clockNow() < end;) {
    const tandem_dds_ObjectState taken = publishUntilTaken(publisher, states, objects);
    if (taken.object == 2) second = taken;
  }
  ASSERT_TRUE(second);
  const RigidState& sent = states.objects[1].state;
  EXPECT_EQ(second->site, 3u);
  EXPECT_EQ(toVec3(second->position), sent.p_W);
  EXPECT_EQ(second->orientation.w, sent.q_WB.w());
  EXPECT_EQ(second->orientation.x, sent.q_WB.x());
  EXPECT_EQ(toVec3(second->velocity), sent.v_W);
  EXPECT_EQ(toVec3(second->angular_velocity), sent.w_W);
}

TEST(StatePublisher, ReadersLearnThatASiteHasGone) {
  const int domain = test::openLoopbackDomain();
  Hands hands(domain, tandem_dds_HandState_desc, "tandem/hands");
  auto publisher = std::make_unique<StatePublisher>(domain);
  (void)publishUntilTaken(*publisher, makeStates(), hands);
  publisher.reset();
  const double end = test::clockNow() + test::kPatience;
  while (hands.state() == DDS_IST_ALIVE && test::clockNow() < end) (void)hands.take();
  EXPECT_EQ(hands.state(), DDS_IST_NOT_ALIVE_DISPOSED);
}

TEST(StatePublisher, RefusesADomainWithoutPorts) {
  EXPECT_THROW(StatePublisher(-1), std::invalid_argument);
  EXPECT_THROW(StatePublisher(233), std::invalid_argument);
}

}  // namespace
}  // namespace tandem
