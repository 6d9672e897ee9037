#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "tandem/falcon/hid_port.h"
#include "tandem/falcon/space_mouse_device.h"

/// \file
/// What a SpaceMouse of 3Dconnexion says. Two layouts are in use, told apart by the length of
/// report 1 (equal products have either, by firmware), identifiers included:
///
///     report 1, 7 bytes    x y z                 old: with report 2 in turn
///     report 2, 7 bytes    rx ry rz
///     report 1, 13 bytes   x y z rx ry rz        new
///     report 3, 2 bytes+   a bit for each button
///     report 0x17          battery
///
/// Numbers are signed, 16 bits, the lower byte first; x is to the right, y towards the user, z
/// down. Bytes from a device are never trusted. Pure and real-time safe.
#pragma GCC visibility push(default)
namespace tandem {

/// A full displacement in counts; some units go beyond.
inline constexpr double kSpaceMouseFull = 350.0;

enum class SpaceMouseNews {
  kRefused,  ///< no such report, or of another length: the state is as it was
  kNothing,  ///< right, but not about the cap
  kPlace,    ///< x y z
  kTurn,     ///< rx ry rz
  kBoth,
  kButtons
};

/// Takes one report into the state, and tells what was in it.
[[nodiscard]] SpaceMouseNews takeSpaceMouseReport(const std::uint8_t* report, std::size_t size,
                                                  SpaceMouseState& state) noexcept;

/// True for a known product that shows the multi-axis usage; the makers' ids are on mice, too.
[[nodiscard]] bool isSpaceMouse(const HidAddress& address) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
