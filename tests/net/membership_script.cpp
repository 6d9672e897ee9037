#include "net/membership_script.h"

#include <algorithm>
#include <array>

#include "net/membership_sites.h"

namespace tandem::test {
namespace {

constexpr double kStep = MembershipSites::kStep;
constexpr std::size_t kMostEvents = 500;
constexpr double kPatience = 10.0;  ///< longest time until all are together again [s]

// Steps of time; the timeouts of a session are among them.
constexpr std::array kTimes = {kStep, 8 * kStep, 10 * kStep, 20 * kStep, 0.25, 0.5,   1.0,   2.0,
                               5.0,   8.75,      10.0,       20.0,       60.0, 118.0, 120.0, 180.0};

/// Reads a script byte by byte; after its end all bytes are zero.
class Reader {
 public:
  explicit Reader(ByteView script) noexcept : script_(script) {}
  [[nodiscard]] bool isAtEnd() const noexcept { return next_ >= script_.size; }
  std::uint8_t byte() noexcept { return isAtEnd() ? std::uint8_t{0} : script_.data[next_++]; }
  std::size_t number() noexcept { return byte() + std::size_t{256} * byte(); }
  /// A timeout, or one step less or more.
  double time() noexcept {
    const std::uint8_t drawn = byte();
    const double about = kTimes[drawn % kTimes.size()];
    const std::size_t aside = drawn / kTimes.size() % 3;
    return aside == 0 ? about : aside == 1 ? std::max(about - kStep, 0.0) : about + kStep;
  }
  std::vector<std::uint8_t> bytes(std::size_t count) {
    std::vector<std::uint8_t> all(count);
    std::generate(all.begin(), all.end(), [this] { return byte(); });
    return all;
  }

 private:
  ByteView script_;
  std::size_t next_ = 0;
};

MembershipSites::Start readStart(Reader& script) {
  const std::uint8_t drawn = script.byte();
  // Most sites have the common key and configuration.
  MembershipSites::Start how;
  how.key = drawn % 16 == 1 ? 1 : 0;
  how.configuration = drawn % 16 == 2 ? 1 : 0;
  how.clock = drawn / 16 % 4 * 1000.0;
  return how;
}

void playEvent(MembershipSites& sites, Reader& script) {
  const auto site = [&] { return script.byte() % sites.count(); };
  switch (script.byte() % 16) {
    case 0:
      return sites.deliver(script.byte());
    case 1:
      return sites.deliver(0);
    case 2:
      return sites.drop(script.byte());
    case 3:
      return sites.repeat(script.byte());
    case 4: {
      const std::size_t which = script.byte(), at = script.byte();
      return sites.change(which, at, static_cast<std::uint8_t>(script.byte() | 1U));
    }
    case 5: {
      const std::size_t which = script.byte();
      return sites.cut(which, script.number());
    }
    case 6:
      return sites.stop(site());
    case 7: {
      const std::size_t which = site();
      return sites.start(which, readStart(script));
    }
    case 8: {
      const std::size_t which = site();
      return sites.leave(which, static_cast<ByeReason>(script.byte() % 4));
    }
    case 9: {
      const std::size_t which = site();
      return sites.rebind(which, script.byte() % 4);
    }
    case 10:  // all sites stand still in the meantime
      return sites.pass(script.time());
    case 11:
    case 12: {
      sites.pass(script.time());
      return sites.act(script.byte());
    }
    case 13:
      return sites.runPerfectly(script.byte() % 64 * 0.0625);
    case 14: {
      const std::size_t which = script.byte();
      return sites.replay(which, script.byte() % 2 == 1);
    }
    default: {
      const std::size_t to = site();
      return sites.forge(to, script.bytes(script.byte()));
    }
  }
}

}  // namespace

std::string playMembershipScript(ByteView bytes) {
  Reader script(bytes);
  MembershipSites sites(2 + script.byte() % 2);
  for (std::size_t i = 0; i < kMostEvents && !script.isAtEnd() && sites.broken().empty(); ++i)
    playEvent(sites, script);
  sites.mend();
  for (double waited = 0.0; waited < kPatience && !sites.areTogether(); waited += 0.125)
    sites.runPerfectly(0.125);
  if (!sites.broken().empty()) return sites.broken();
  return sites.areTogether() ? "" : "not together again";
}

}  // namespace tandem::test
