#pragma once

#include <cstdint>
#include <random>

#include <sodium.h>

/// \file
/// Keys, cookies and sessions are drawn from a seed, so that equal input gives equal runs.
namespace tandem::fuzz {

inline std::mt19937_64 engine;

/// Before sodium_init().
inline void drawFromSeed() {
  static randombytes_implementation drawn{};
  drawn.implementation_name = [] { return "seeded"; };
  drawn.random = [] { return static_cast<std::uint32_t>(engine()); };
  drawn.buf = [](void* bytes, std::size_t size) {
    auto* all = static_cast<std::uint8_t*>(bytes);
    for (std::size_t i = 0; i < size; ++i) all[i] = static_cast<std::uint8_t>(engine());
  };
  randombytes_set_implementation(&drawn);
}

/// At the start of each input.
inline void seedAgain() { engine.seed(2009); }

}  // namespace tandem::fuzz
