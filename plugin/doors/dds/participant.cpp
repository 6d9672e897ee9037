#include "dds/participant.h"

#include <cstdio>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tandem/coordination/types.h"

#include "dds/dds_carrier.h"

namespace tandem::dds {
namespace {

int checkDomain(int domain) {
  if (domain < 0 || domain > kHighestDdsDomain)
    throw std::invalid_argument("DDS domain " + std::to_string(domain) + ": must be 0 to " +
                                std::to_string(kHighestDdsDomain));
  return domain;
}

Error makeError(int domain, const std::string& why) {
  return Error("cannot open DDS domain " + std::to_string(domain) + ": " + why +
               "; look at the network and at CYCLONEDDS_URI");
}

/// Keeps what Cyclone would print, while it lives.
class LogCatch {
 public:
  LogCatch() noexcept { dds_set_log_sink(&LogCatch::keep, this); }
  ~LogCatch() { dds_set_log_sink(nullptr, nullptr); }
  LogCatch(const LogCatch&) = delete;
  LogCatch& operator=(const LogCatch&) = delete;

  [[nodiscard]] const std::vector<std::string>& lines() const noexcept { return lines_; }

 private:
  static void keep(void* self, const dds_log_data_t* line) {
    std::string text(line->message, line->size);
    text.erase(text.find_last_not_of(".\n") + 1);
    static_cast<LogCatch*>(self)->lines_.push_back(std::move(text));
  }

  std::vector<std::string> lines_;
};

/// The reason of a failure goes into the error, so that it is one line. Warnings are printed.
dds_entity_t openDomain(int domain) {
  const LogCatch log;
  const dds_entity_t entity =
      dds_create_participant(static_cast<dds_domainid_t>(domain), nullptr, nullptr);
  if (entity < 0 && !log.lines().empty()) throw makeError(domain, log.lines().back());
  for (const std::string& line : log.lines()) std::fprintf(stderr, "Cyclone: %s\n", line.c_str());
  return checkEntity(entity, domain);
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
  throw makeError(domain, dds_strretcode(entity));
}

Participant::Participant(int domain) : domain_(checkDomain(domain)), entity_(openDomain(domain)) {}

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
