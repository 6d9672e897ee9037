#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "tandem/falcon/hid_port.h"
#include "tandem/falcon/space_mouse_device.h"

/// \file
/// Reports of a 3Dconnexion SpaceMouse. Two layouts exist, told apart by the length of report 1
/// with its identifier. The same product may use either, depending on its firmware:
///
///     report 1, 7 bytes    x y z                 old: with report 2 in turn
///     report 2, 7 bytes    rx ry rz
///     report 1, 13 bytes   x y z rx ry rz        new
///     report 3, 2 bytes+   a bit for each button
///     report 0x17          battery
///
/// Numbers are signed 16-bit, lower byte first. x points right, y towards the user, z down. Every
/// byte from the device is checked. Pure and real-time safe.
#pragma GCC visibility push(default)
namespace tandem {

/// Counts of full displacement; some units exceed it.
inline constexpr double kSpaceMouseFull = 350.0;

enum class SpaceMouseNews {
  kRefused,  ///< unknown report or wrong length: the state is unchanged
  kNothing,  ///< valid, but not about the cap
  kPlace,    ///< x y z
  kTurn,     ///< rx ry rz
  kBoth,
  kButtons
};

/// Applies one report to the state, and tells what it contained.
[[nodiscard]] SpaceMouseNews takeSpaceMouseReport(const std::uint8_t* report, std::size_t size,
                                                  SpaceMouseState& state) noexcept;

/// True for a known product with the multi-axis usage. The vendor identifiers alone also match
/// mice.
[[nodiscard]] bool isSpaceMouse(const HidAddress& address) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
