#include "hid/ft260_reports.h"

#include <algorithm>

namespace tandem {
namespace {

enum : std::uint8_t { kSystem = 0xA1, kUartMode = 0x03, kUartConfig = 0x41, kNoFlowControl = 0x04 };
constexpr std::uint8_t kFirstData = 0xF0, kLastData = 0xFE;
constexpr std::size_t kHead = 2, kStep = 4;

}  // namespace

HidReport encodeUartBytes(const std::uint8_t* bytes, std::size_t count) noexcept {
  HidReport report;
  if (count == 0) return report;
  count = std::min(count, kMostUartBytes);
  const std::size_t step = (count - 1) / kStep;
  report.bytes[0] = static_cast<std::uint8_t>(kFirstData + step);
  report.bytes[1] = static_cast<std::uint8_t>(count);
  std::copy_n(bytes, count, report.bytes.begin() + kHead);
  report.size = kHead + kStep * (step + 1);
  return report;
}

std::optional<UartBytes> decodeUartBytes(const std::uint8_t* report, std::size_t size) noexcept {
  if (size <= kHead || report[0] < kFirstData || report[0] > kLastData) return std::nullopt;
  const std::size_t most = kStep * (report[0] - kFirstData + 1U);
  UartBytes content;
  content.count = report[1];
  if (content.count == 0 || content.count > most || content.count > size - kHead)
    return std::nullopt;
  std::copy_n(report + kHead, content.count, content.bytes.begin());
  return content;
}

HidReport makeUartOn() noexcept { return {{kSystem, kUartMode, kNoFlowControl}, 3}; }

HidReport makeUartLine(std::uint32_t baud) noexcept {
  HidReport report{{kSystem, kUartConfig, kNoFlowControl}, 11};
  for (std::size_t i = 0; i < 4; ++i)
    report.bytes[3 + i] = static_cast<std::uint8_t>(baud >> (8 * i));
  report.bytes[7] = 8;
  return report;
}

}  // namespace tandem
