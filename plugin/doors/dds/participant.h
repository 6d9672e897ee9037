#pragma once

#include <cstdint>
#include <memory>

#include <dds/dds.h>

namespace tandem::dds {

/// Gives `entity` back. Throws tandem::Error with the remedy if Cyclone could not make it.
dds_entity_t checkEntity(dds_entity_t entity, int domain);

/// A member of a domain. Deleted with all entities that were made of it.
class Participant {
 public:
  /// Throws std::invalid_argument for a domain that is not 0 to kHighestDdsDomain, and as
  /// checkEntity() does.
  explicit Participant(int domain);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  [[nodiscard]] dds_entity_t entity() const noexcept { return entity_; }
  /// Entities of this domain. They throw as checkEntity() does.
  [[nodiscard]] dds_entity_t makeTopic(const dds_topic_descriptor_t& type, const char* name) const;
  [[nodiscard]] dds_entity_t makeWriter(dds_entity_t topic, std::int32_t kept) const;
  [[nodiscard]] dds_entity_t makeReader(dds_entity_t topic, std::int32_t kept) const;
  [[nodiscard]] dds_entity_t check(dds_entity_t entity) const {
    return checkEntity(entity, domain_);
  }

 private:
  int domain_;
  dds_entity_t entity_;
};

}  // namespace tandem::dds
