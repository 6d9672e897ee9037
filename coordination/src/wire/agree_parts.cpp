#include <stdexcept>

#include "wire/wire_agree.h"

// Splits a configuration into parts that fit one datagram each, and joins them again.
namespace tandem {
namespace {

constexpr std::size_t kRoom = kMaxPayloadSize - 7;  // for items [bytes]
constexpr std::size_t kMaxItems = 255;

std::size_t sizeOf(const ConfigurationItem& item) noexcept {
  return 2 + item.key.size() + item.value.size();
}

std::vector<Configuration> cut(const Configuration& configuration) {
  std::vector<Configuration> pieces(1);
  std::size_t used = 0;
  for (const ConfigurationItem& item : configuration) {
    if (used + sizeOf(item) > kRoom || pieces.back().size() == kMaxItems) {
      pieces.emplace_back();
      used = 0;
    }
    pieces.back().push_back(item);
    used += sizeOf(item);
  }
  return pieces;
}

Configuration join(const std::vector<Configuration>& pieces) {
  Configuration whole;
  for (const Configuration& piece : pieces) whole.insert(whole.end(), piece.begin(), piece.end());
  return whole;
}

}  // namespace

std::vector<AgreePart> makeAgreeParts(const Configuration& configuration) {
  const std::vector<Configuration> pieces = cut(configuration);
  if (pieces.size() > kMaxAgreeParts) {
    throw std::invalid_argument("a configuration of " + std::to_string(configuration.size()) +
                                " items takes " + std::to_string(pieces.size()) +
                                " datagrams: must be at most 32; use shorter keys or values");
  }
  const std::uint32_t config_hash = hashConfiguration(configuration);
  std::vector<AgreePart> parts;
  for (const Configuration& piece : pieces) {
    parts.push_back({config_hash, static_cast<std::uint8_t>(parts.size()),
                     static_cast<std::uint8_t>(pieces.size()), piece});
  }
  return parts;
}

bool AgreeCollector::add(const AgreePart& part) {
  if (part.parts < 1 || part.parts > kMaxAgreeParts || part.part >= part.parts) return false;
  if (part.config_hash != config_hash_ || parts_.empty()) {
    config_hash_ = part.config_hash;
    received_ = 0;
    parts_.assign(part.parts, {});
  }
  if (part.parts != parts_.size()) return false;
  parts_[part.part] = part.items;
  received_ |= std::uint32_t{1} << part.part;
  return true;
}

bool AgreeCollector::complete() const noexcept {
  const std::uint64_t all = (std::uint64_t{1} << parts_.size()) - 1;
  return !parts_.empty() && received_ == all;
}

Configuration AgreeCollector::items() const { return join(parts_); }

AgreeAnswer AgreeCollector::answer(const Configuration& here) {
  AgreeAnswer answer;
  answer.config_hash = config_hash_;
  if (complete() && hashConfiguration(join(parts_)) != config_hash_) {
    received_ = 0;
    parts_.clear();
  }
  answer.parts_received = received_;
  if (!complete()) return answer;
  const auto difference = findFirstDifference(here, join(parts_));
  answer.verdict = difference ? AgreeVerdict::kDifferent : AgreeVerdict::kEqual;
  if (difference) {
    answer.key = difference->key;
    answer.value = difference->here;
  }
  return answer;
}

}  // namespace tandem
