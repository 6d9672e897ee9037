#pragma once

#include <optional>
#include <string_view>

namespace tandem::demos {

/// The longest accepted delay [s]. A larger one probably lacks its "ms".
inline constexpr double kLongestDelay = 10.0;

inline constexpr const char* kAllowedDelay = "a time from 0s to 10s, such as 50ms or 0.05s";
inline constexpr const char* kAllowedShare = "a share from 0% to 100%, such as 2% or 0.02";

/// Seconds of "50ms", "0.05s", "200us" or plain "0.05"; empty if the text is no such time, negative
/// or not finite. Pure.
[[nodiscard]] std::optional<double> parseSeconds(std::string_view text) noexcept;

/// Like parseSeconds(), but empty above kLongestDelay.
[[nodiscard]] std::optional<double> parseDelay(std::string_view text) noexcept;

/// 0.02 of "2%" or "0.02"; empty if the text is no such share, or not 0 to 1. Pure.
[[nodiscard]] std::optional<double> parseShare(std::string_view text) noexcept;

}  // namespace tandem::demos
