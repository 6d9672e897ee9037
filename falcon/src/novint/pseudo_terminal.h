#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace tandem::falcon_detail {

/// The far end of a pseudo terminal: what a device would be at a serial line. Linux.
class PseudoTerminal {
 public:
  /// Throws tandem::Error if there is none to be had.
  PseudoTerminal();
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  /// What the other program opens.
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// As the other program has set it [Bd]; 0 if that cannot be told.
  [[nodiscard]] int readSpeed() const noexcept;
  /// What has come, after waiting for it up to `wait` [s]; 0 also while nobody has it open.
  [[nodiscard]] std::size_t read(std::uint8_t* bytes, std::size_t room, double wait) noexcept;
  /// What the other program does not take in time is lost, as on a line.
  void write(const std::uint8_t* bytes, std::size_t count) noexcept;

 private:
  int fd_;
  std::string path_;
};

}  // namespace tandem::falcon_detail
