#include "dds/state_publisher.h"

#include <limits>

#include "dds/participant.h"
#include "states.h"

namespace tandem {
namespace {

constexpr std::int32_t kNewest = 1;  // older samples are of no use

tandem_dds_Vector toDds(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

tandem_dds_Quaternion toDds(const Quat& q) { return {q.w(), q.x(), q.y(), q.z()}; }

tandem_dds_HandState makeHand(const SiteStates& states) {
  const Vec3 unknown = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  return {.site = static_cast<std::uint32_t>(states.site),
          .tick = states.tick,
          .time = states.time,
          .position = toDds(states.hand.p_W),
          .velocity = toDds(states.hand.v_W),
          .force = toDds(states.force_W.value_or(unknown))};
}

tandem_dds_ObjectState makeObject(const SiteStates& states, const ObjectState& object) {
  return {.site = static_cast<std::uint32_t>(states.site),
          .object = object.id,
          .tick = states.tick,
          .time = states.time,
          .position = toDds(object.state.p_W),
          .orientation = toDds(object.state.q_WB),
          .velocity = toDds(object.state.v_W),
          .angular_velocity = toDds(object.state.w_W)};
}

}  // namespace

struct StatePublisher::Impl {
  explicit Impl(int domain) : participant(domain) {}

  [[nodiscard]] dds_entity_t makeWriter(const dds_topic_descriptor_t& type, const char* name) {
    return participant.makeWriter(participant.makeTopic(type, name), kNewest);
  }

  dds::Participant participant;
  dds_entity_t hands = makeWriter(tandem_dds_HandState_desc, "tandem/hands");
  dds_entity_t objects = makeWriter(tandem_dds_ObjectState_desc, "tandem/objects");
};

StatePublisher::StatePublisher(int domain) : impl_(std::make_unique<Impl>(domain)) {}

StatePublisher::~StatePublisher() = default;

void StatePublisher::publish(const SiteStates& states) noexcept {
  const tandem_dds_HandState hand = makeHand(states);
  (void)dds_write(impl_->hands, &hand);
  for (const ObjectState& one : states.objects) {
    const tandem_dds_ObjectState object = makeObject(states, one);
    (void)dds_write(impl_->objects, &object);
  }
}

}  // namespace tandem
