#include "tandem/coordination/impairments.h"

#include <algorithm>
#include <cmath>

#include "bad_value.h"
#include "link/counter_random.h"

namespace tandem {
namespace {

/// Each decision has its own random stream, so that no impairment shifts another's draws. The
/// values define the meaning of a seed: add new decisions at the end.
enum class Stream : std::uint64_t {
  kLoss,
  kDuplicate,
  kReorder,
  kJitter,
  kDuplicateJitter,
  kCorrupt,
  kCorruptBit,
  kDuplicateCorrupt,
  kDuplicateCorruptBit,
};

/// The random draws of one packet.
struct Draws {
  std::uint64_t seed;
  Direction direction;
  std::uint64_t number;

  [[nodiscard]] double operator()(Stream stream) const noexcept {
    return drawUniform(seed, static_cast<std::uint64_t>(direction),
                       static_cast<std::uint64_t>(stream), number);
  }
};

double computeDelay(const Impairments& impairments, double draw) noexcept {
  const double deviation = impairments.jitter * (2.0 * draw - 1.0);
  return std::max(0.0, impairments.delay + deviation);
}

void checkTime(const char* name, double value) {
  if (!(std::isfinite(value) && value >= 0.0))
    throwBadValue(name, value, "finite and not below 0 s");
}

void checkProbability(const char* name, double value) {
  if (!(value >= 0.0 && value <= 1.0)) throwBadValue(name, value, "a probability from 0 to 1");
}

}  // namespace

void checkImpairments(const Impairments& impairments) {
  checkTime("network delay", impairments.delay);
  checkTime("network jitter", impairments.jitter);
  checkProbability("network loss", impairments.loss);
  checkProbability("network duplicate", impairments.duplicate);
  checkProbability("network reorder", impairments.reorder);
}

PacketFate computeFate(const Impairments& impairments, Direction direction,
                       std::uint64_t number) noexcept {
  const Draws draw{impairments.seed, direction, number};
  PacketFate fate;
  fate.is_lost = draw(Stream::kLoss) < impairments.loss;
  fate.is_reordered = draw(Stream::kReorder) < impairments.reorder;
  fate.is_duplicated = draw(Stream::kDuplicate) < impairments.duplicate;
  if (!fate.is_reordered) fate.delay = computeDelay(impairments, draw(Stream::kJitter));
  fate.duplicate_delay = computeDelay(impairments, draw(Stream::kDuplicateJitter));
  return fate;
}

std::optional<std::size_t> computeCorruptBit(double probability, std::uint64_t seed,
                                             Direction direction, std::uint64_t number, Copy copy,
                                             std::size_t size) noexcept {
  const Draws draw{seed, direction, number};
  const bool is_first = copy == Copy::kFirst;
  if (size == 0 || !(draw(is_first ? Stream::kCorrupt : Stream::kDuplicateCorrupt) < probability))
    return std::nullopt;
  const double place = draw(is_first ? Stream::kCorruptBit : Stream::kDuplicateCorruptBit);
  return static_cast<std::size_t>(place * 8.0 * static_cast<double>(size));
}

}  // namespace tandem
