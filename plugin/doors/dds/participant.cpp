#include "dds/participant.h"

#include <stdexcept>
#include <string>

#include "tandem/coordination/types.h"

namespace tandem::dds {
namespace {

constexpr int kHighestDomain = 232;  // its ports end below 65536

int checkDomain(int domain) {
  if (domain < 0 || domain > kHighestDomain)
    throw std::invalid_argument("DDS domain " + std::to_string(domain) + ": must be 0 to 232");
  return domain;
}

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

/// Best effort: a lost sample never holds up a newer one.
Qos makeQos(std::int32_t kept) {
  Qos qos(dds_create_qos(), &dds_delete_qos);
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, kept);
  return qos;
}

}  // namespace

dds_entity_t checkEntity(dds_entity_t entity, int domain) {
  if (entity >= 0) return entity;
  throw Error("cannot open DDS domain " + std::to_string(domain) + ": " + dds_strretcode(entity) +
              "; look at the network and at CYCLONEDDS_URI");
}

Participant::Participant(int domain)
    : domain_(checkDomain(domain)),
      entity_(
          check(dds_create_participant(static_cast<dds_domainid_t>(domain), nullptr, nullptr))) {}

Participant::~Participant() { (void)dds_delete(entity_); }

dds_entity_t Participant::makeTopic(const dds_topic_descriptor_t& type, const char* name) const {
  return check(dds_create_topic(entity_, &type, name, nullptr, nullptr));
}

dds_entity_t Participant::makeWriter(dds_entity_t topic, std::int32_t kept) const {
  return check(dds_create_writer(entity_, topic, makeQos(kept).get(), nullptr));
}

dds_entity_t Participant::makeReader(dds_entity_t topic, std::int32_t kept) const {
  return check(dds_create_reader(entity_, topic, makeQos(kept).get(), nullptr));
}

}  // namespace tandem::dds
