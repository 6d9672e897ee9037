#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "tandem/falcon/hid_port.h"
#include "tandem/falcon/raw_hid_device.h"

#include "novint/falcon_kinematics.h"

/// \file
/// Reports of a haptic device with the Falcon's legs and its own controller, over raw HID. Reports
/// have 64 bytes each way and no identifiers; usage page FFAB, usage 0200. docs/hid.md specifies
/// the format. The lower byte comes first.
///
///     byte       0         1      2 3    4 5  6 7  8 9     10       11        12..15      62 63
///     state      1 (ver.)  'S'    number counts of legs    homed    buttons   time [us]   CRC
///     command    1         'C'    number torques of legs   flags    0         0           CRC
///
/// All other bytes are 0. The CRC is CRC-16/CCITT-FALSE of bytes 0 to 61. Every byte from the
/// device is checked. Pure, real-time safe.
namespace tandem {

inline constexpr std::size_t kRawHidSize = 64;
inline constexpr double kRawHidTorque = 50e-6;  ///< unit of a torque at the arm [N m]

enum RawHidFlag : std::uint8_t {
  kRawHidDrive = 0x01,  ///< motors on; without this bit torques are 0
  kRawHidHome = 0x02    ///< search for the index marks
};

struct RawHidCommand {
  std::uint16_t number = 0;               ///< grows by one per report, wraps
  std::array<std::int16_t, 3> torques{};  ///< torques at the legs' arms, in kRawHidTorque
  std::uint8_t flags = 0;                 ///< bits of RawHidFlag
};

using RawHidBytes = std::array<std::uint8_t, kRawHidSize>;

[[nodiscard]] RawHidBytes encodeRawState(const RawHidState& state) noexcept;
[[nodiscard]] RawHidBytes encodeRawCommand(const RawHidCommand& command) noexcept;

/// Returns nothing for a wrong length, version, kind or CRC and for an undefined bit. Also refuses
/// torques without kRawHidDrive.
[[nodiscard]] std::optional<RawHidState> decodeRawState(const std::uint8_t* bytes,
                                                        std::size_t size) noexcept;
[[nodiscard]] std::optional<RawHidCommand> decodeRawCommand(const std::uint8_t* bytes,
                                                            std::size_t size) noexcept;

/// The report with the leading 0 that hidraw wants for a device without identifiers.
[[nodiscard]] HidReport toReport(const RawHidBytes& bytes) noexcept;

/// Encodes torques [N m] in kRawHidTorque. If one is out of range, all three are scaled alike.
/// Non-finite torques give zero.
[[nodiscard]] std::array<std::int16_t, 3> makeRawTorques(const Vec3& torques) noexcept;

/// CRC-16/CCITT-FALSE: polynomial 1021, initial value FFFF, no reflection. "123456789" gives 29B1.
[[nodiscard]] std::uint16_t computeCrc16(const std::uint8_t* bytes, std::size_t size) noexcept;

/// Report descriptor of such a device.
[[nodiscard]] std::vector<std::uint8_t> makeRawHidDescriptor();

}  // namespace tandem
