#include "net/loss_meter.h"

#include <gtest/gtest.h>

namespace tandem::net {
namespace {

constexpr double kPeriod = 0.01;  // between two states [s]

/// A peer that sends 100 states a second for 1.5 s. `sends` says what becomes of number n.
class Sender {
 public:
  LossMeter meter;

  void challenge() { ++datagram_; }  // to another address: it does not come
  void send(int n, bool comes, int state_number) {
    const auto datagram = datagram_++;
    if (!comes) return;
    meter.noteDatagram(datagram);
    meter.noteState(static_cast<std::uint64_t>(state_number), kPeriod * n);
  }

 private:
  std::uint64_t datagram_ = 0;
};

TEST(LossMeter, CountsLostStates) {
  Sender sender;
  for (int n = 0; n < 150; ++n) sender.send(n, n % 4 != 1, n);
  EXPECT_NEAR(sender.meter.loss(), 0.25, 0.01);
}

// While the relay carries, six challenges a second go to a direct address where nobody is.
TEST(LossMeter, ChallengesToASilentAddressAreNoLoss) {
  Sender sender;
  for (int n = 0; n < 150; ++n) {
    if (n % 16 == 0) sender.challenge();
    sender.send(n, true, n);
  }
  EXPECT_EQ(sender.meter.loss(), 0.0);
}

// A peer numbers its states for all sites together, and tells some of them rarely.
TEST(LossMeter, StatesToOtherPeersAreNoLoss) {
  Sender sender;
  for (int n = 0; n < 150; ++n) sender.send(n, true, 3 * n);
  EXPECT_EQ(sender.meter.loss(), 0.0);
}

TEST(LossMeter, OneThatComesLateIsNoLoss) {
  LossMeter meter;
  for (int n = 0; n < 150; ++n) {
    const auto number = static_cast<std::uint64_t>(n ^ 1);  // 1 0 3 2 5 4
    meter.noteDatagram(number);
    meter.noteState(number, kPeriod * n);
  }
  EXPECT_EQ(meter.loss(), 0.0);
}

TEST(LossMeter, NewKeysBeginAnew) {
  Sender sender;
  for (int n = 0; n < 50; ++n) sender.send(n, n % 2 == 0, n);
  sender.meter.begin();
  for (int n = 50; n < 200; ++n) sender.send(n, true, n);
  EXPECT_EQ(sender.meter.loss(), 0.0);
}

}  // namespace
}  // namespace tandem::net
