#include "net/agreement.h"

namespace tandem::net {

Agreement::Agreement(const Configuration& here)
    : here_(here), hash_(hashConfiguration(here)), parts_(makeAgreeParts(here)) {}

void Agreement::restart() noexcept {
  acknowledged_ = 0;
  next_ = 0;
  is_heard_ = false;
}

std::size_t Agreement::onAgree(const AgreePart& part, ByteSpan answer) {
  if (!collector_.add(part)) return 0;
  const AgreeAnswer said = collector_.answer(here_);
  if (said.verdict == AgreeVerdict::kEqual) {
    is_equal_here_ = true;
    difference_.reset();
  } else if (said.verdict == AgreeVerdict::kDifferent) {
    is_equal_here_ = false;
    const Configuration& there = collector_.items();
    difference_ = findFirstDifference(here_, there);
  }
  return encodeAgreeAck(said, answer);
}

void Agreement::onAnswer(const AgreeAnswer& answer) {
  if (answer.config_hash != hash_) return;
  acknowledged_ |= answer.parts_received;
  const std::uint32_t all =
      parts_.size() == kMaxAgreeParts ? ~std::uint32_t{0} : (std::uint32_t{1} << parts_.size()) - 1;
  // Answers may overtake each other: one about some parts does not withdraw one about all.
  if (answer.verdict == AgreeVerdict::kIncomplete) return;
  is_heard_ = (acknowledged_ & all) == all;
  is_equal_there_ = answer.verdict == AgreeVerdict::kEqual;
  if (answer.verdict != AgreeVerdict::kDifferent || difference_) return;
  ConfigurationDifference difference{answer.key, "", answer.value};
  for (const ConfigurationItem& item : here_)
    if (item.key == answer.key) difference.here = item.value;
  difference_ = difference;
}

std::size_t Agreement::nextPart(ByteSpan payload) {
  while (next_ < parts_.size() && (acknowledged_ >> next_ & 1U) != 0) ++next_;
  if (next_ >= parts_.size()) {
    next_ = 0;
    return 0;
  }
  return encodeAgree(parts_[next_++], payload);
}

}  // namespace tandem::net
