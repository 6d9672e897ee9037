#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <optional>

#include <gtest/gtest.h>

#include "dds/dds_carrier.h"
#include "dds/loopback_domain.h"

namespace tandem::test {

constexpr double kPatience = 30.0;  // for what comes by another thread [s]

inline double clockNow() {
  static const auto start = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The newest of numbers that wait at a carrier; 0: none.
inline std::uint32_t takeNumber(DdsCarrier& at) {
  std::uint32_t number = 0;
  std::array<std::uint8_t, sizeof number> room{};
  while (at.receive({room.data(), room.size()})) std::memcpy(&number, room.data(), room.size());
  return number;
}

/// Sends numbers until the receiver has found the sender, and takes all of them.
inline void meet(DdsCarrier& sender, PeerId to, DdsCarrier& receiver) {
  std::uint32_t sent = 0, heard = 0;
  std::array<std::uint8_t, sizeof sent> bytes{};
  const double end = clockNow() + kPatience;
  while (heard < std::max(sent, 1u) && clockNow() < end) {
    if (heard == 0) {
      ++sent;
      std::memcpy(bytes.data(), &sent, sizeof sent);
      sender.send({bytes.data(), bytes.size()}, to);
    }
    receiver.wait(1e-3);
    heard = std::max(heard, takeNumber(receiver));
  }
  ASSERT_EQ(heard, sent);
}

/// Two sites on the bus that have found each other.
struct DdsPair {
  DdsPair() {
    meet(first, PeerId{2}, second);
    meet(second, PeerId{1}, first);
  }

  const int domain = openLoopbackDomain();
  DdsCarrier first{domain, PeerId{1}, {PeerId{2}}};
  DdsCarrier second{domain, PeerId{2}, {PeerId{1}}};
};

}  // namespace tandem::test
