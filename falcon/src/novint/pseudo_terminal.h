#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace tandem::falcon_detail {

/// The far end of a pseudo terminal, in place of a device at a serial line. Linux only.
class PseudoTerminal {
 public:
  /// Throws tandem::Error if no pseudo terminal is available.
  PseudoTerminal();
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  /// Path for the other program to open.
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// Speed set by the other program [Bd]; 0 if unknown.
  [[nodiscard]] int readSpeed() const noexcept;
  /// Waits up to `wait` [s] for bytes, and returns how many were read. Returns 0 also while no
  /// program has the terminal open.
  [[nodiscard]] std::size_t read(std::uint8_t* bytes, std::size_t room, double wait) noexcept;
  /// Sends bytes. Those that the other program does not take in time are lost, as on a line.
  void write(const std::uint8_t* bytes, std::size_t count) noexcept;

 private:
  int fd_;
  std::string path_;
};

}  // namespace tandem::falcon_detail
