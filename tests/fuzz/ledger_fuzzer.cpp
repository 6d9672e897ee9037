// A script of events for accounts of energy at three sites: hands and worlds that work, reports
// that are sent, delivered, lost and repeated, sites that begin anew, and a fourth that lies.
// No event makes energy on the way, and no account leaves its limits.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "tandem/coordination/passivity_observer.h"

#include "coordination/src/link/energy_ledger.h"

namespace tandem {
namespace {

constexpr int kSites = 3;
constexpr double kWire = 1e9;        // limit of the wire [J]
constexpr double kRounding = 1e-6;   // of sums of some thousand joules [J]
constexpr double kMostLied = 0.01;   // credited of one report of the liar [J]
constexpr std::size_t kFlying = 64;  // reports on their way, at most

void require(bool holds) {
  if (!holds) std::abort();
}

/// Reads a script byte by byte; after its end all bytes are zero.
class Script {
 public:
  Script(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  [[nodiscard]] bool isAtEnd() const { return next_ >= size_; }
  std::uint8_t byte() { return isAtEnd() ? std::uint8_t{0} : data_[next_++]; }
  int site() { return byte() % kSites; }
  double work() { return 1e-3 * (byte() - 128); }  // [J]
  /// Any number that the wire lets pass.
  double number() {
    std::array<std::uint8_t, 8> bytes;
    for (std::uint8_t& one : bytes) one = byte();
    double value = 0.0;
    std::memcpy(&value, bytes.data(), sizeof value);
    return std::isfinite(value) ? std::clamp(value, -kWire, kWire) : 0.0;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_, next_ = 0;
};

/// An account and its ledger with each peer; the last ledger is the liar's.
struct Account {
  PassivityObserver observer;
  std::array<EnergyLedger, kSites + 1> ledgers;
  std::array<std::uint64_t, kSites> newest{};  ///< number of each peer's newest report
  double hand = 0.0, world = 0.0;              ///< work put in so far [J]
};

struct Flying {
  int from = 0, to = 0;
  std::uint64_t number = 0;
  EnergyReport report;
};

class Sites {
 public:
  void play(Script& script) {
    switch (script.byte() % 8) {
      case 0:
        return work(script.site(), script.work());
      case 1:
        return workOfWorld(script.site(), script.work());
      case 2:
      case 3: {
        const int from = script.site();
        return send(from, (from + 1 + script.byte() % 2) % kSites);
      }
      case 4:
        return deliver(script.byte(), false);
      case 5:
        return deliver(script.byte(), true);
      case 6:
        return beginAnew(script.site());
      default: {
        const int to = script.site();
        const double granted = script.number();
        return lie(to, {granted, script.number()});
      }
    }
  }

  void check() const {
    double held = 0.0, put_in = ended_ + lied_;
    for (const Account& account : accounts_) {
      const double available = account.observer.available();
      require(std::isfinite(available));
      require(available <= settings_.tank + settings_.most + kRounding);
      held += available;
      put_in += settings_.tank + account.hand + std::max(0.0, account.world);
    }
    require(held <= put_in + kRounding);
  }

 private:
  [[nodiscard]] Account& at(int site) { return accounts_[static_cast<std::size_t>(site)]; }

  /// A hand never takes more than there is.
  void work(int site, double energy) {
    Account& account = at(site);
    const double done = std::max(energy, -std::max(0.0, account.observer.available()));
    account.observer.addHand(done);
    account.hand += done;
    require(account.observer.overdrawn() <= kRounding);
  }

  void workOfWorld(int site, double energy) {
    at(site).observer.addWorld(energy);
    at(site).world += energy;
  }

  EnergyReport grant(Account& account, EnergyLedger& ledger) {
    const double before = account.observer.available();
    account.observer.addMoved(-ledger.grant(before, settings_.tank, kSites));
    // A site never gives its tank away.
    require(account.observer.available() >= std::min(before, settings_.tank) - kRounding);
    const EnergyReport report = ledger.report(account.observer.available());
    require(std::abs(report.granted) <= kWire && std::abs(report.holdings) <= kWire);
    return report;
  }

  void send(int from, int to) {
    if (flying_.size() >= kFlying) flying_.erase(flying_.begin());
    Account& account = at(from);
    flying_.push_back(
        {from, to, ++numbers_, grant(account, account.ledgers[static_cast<std::size_t>(to)])});
  }

  void deliver(std::size_t which, bool comes_again) {
    if (flying_.empty()) return;
    const auto place = flying_.begin() + static_cast<std::ptrdiff_t>(which % flying_.size());
    const Flying flying = *place;
    if (!comes_again) flying_.erase(place);
    Account& account = at(flying.to);
    const auto from = static_cast<std::size_t>(flying.from);
    if (flying.number <= account.newest[from]) return;
    account.newest[from] = flying.number;
    account.observer.addMoved(account.ledgers[from].hear(flying.report));
  }

  /// The site loses its holdings, and its peers keep what they got. New keys open no datagram that
  /// is on its way.
  void beginAnew(int site) {
    const Account& account = at(site);
    ended_ +=
        settings_.tank + account.hand + std::max(0.0, account.world) - account.observer.available();
    at(site) = Account();
    flying_.erase(
        std::remove_if(flying_.begin(), flying_.end(),
                       [site](const Flying& f) { return f.from == site || f.to == site; }),
        flying_.end());
  }

  void lie(int to, const EnergyReport& report) {
    Account& account = at(to);
    EnergyLedger& ledger = account.ledgers.back();
    const double credited = std::min(ledger.hear(report), kMostLied);
    account.observer.addMoved(credited);
    lied_ += credited;
    (void)grant(account, ledger);
  }

  PassivitySettings settings_;
  std::array<Account, kSites> accounts_;
  std::vector<Flying> flying_;
  std::uint64_t numbers_ = 0;
  double ended_ = 0.0, lied_ = 0.0;  ///< put in by accounts that ended, and by the liar [J]
};

}  // namespace
}  // namespace tandem

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tandem::Script script(data, size);
  tandem::Sites sites;
  while (!script.isAtEnd()) {
    sites.play(script);
    sites.check();
  }
  return 0;
}
