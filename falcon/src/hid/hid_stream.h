#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "tandem/falcon/hid_port.h"

#include "guard/device_thread.h"

namespace tandem {

/// Handles the reports of a HidStream. Some devices report changes only: a SpaceMouse alternates
/// translation and rotation. No report may then be skipped, so the reader's thread takes each one
/// and publishes the accumulated state.
class HidClient {
 public:
  virtual ~HidClient() = default;

  /// Takes an input report that came at `now` [s] of the stream's clock. Called on the reader's
  /// thread. Returns false for an invalid report, which is counted.
  [[nodiscard]] virtual bool takeReport(const std::uint8_t* report, std::size_t size,
                                        double now) noexcept = 0;

  /// Returns the report to send now; size 0 sends nothing. Called on the writer's thread once per
  /// write period.
  [[nodiscard]] virtual HidReport giveReport(double now) noexcept;

  /// Returns a report that leads to motors off; size 0 sends nothing. Called on the writer's thread
  /// six times, at least 1 ms apart, before the port is closed. The device may be gone already.
  [[nodiscard]] virtual HidReport giveLastReport(double now) noexcept;

  /// The device was connected or lost. Never called together with takeReport(). The writer's thread
  /// does not exist on connection, but may run on loss.
  virtual void setConnected(bool is_connected) noexcept = 0;
};

/// The same settings for a device that is only read.
[[nodiscard]] HidStreamSettings withoutWriting(HidStreamSettings settings) noexcept;

/// Carries reports between a HID device and its client, with one thread for reading and one for
/// writing. A write to a HID device takes 0.3 ms, at times 14 ms, so the haptic thread must not
/// wait for it. Reopens the device by itself after it was unplugged. Its destructor sends the last
/// reports and joins both threads.
class HidStream {
 public:
  /// Opens the device. Throws what `open` throws, and tandem::Error if it returns no port. Throws
  /// std::invalid_argument for settings out of range. The client must outlive the stream.
  HidStream(HidOpener open, HidClient& client, const HidStreamSettings& settings = {});
  HidStream(const HidStream&) = delete;
  HidStream& operator=(const HidStream&) = delete;

  /// Wait-free, for any thread.
  [[nodiscard]] bool isConnected() const noexcept { return is_connected_; }
  [[nodiscard]] HidStreamCounters counters() const noexcept;

  /// Name of the device, and why it could not be reopened ("" if it could). Not for the haptic
  /// thread.
  [[nodiscard]] std::string name() const { return reader_.name(); }
  [[nodiscard]] std::string trouble() const { return reader_.trouble(); }

 private:
  void connect();
  void startWriter();
  void disconnect() noexcept;
  void readUntilGone() noexcept;
  void writeUntilGone() noexcept;
  void sayLastWords() noexcept;
  void send(const HidReport& report) noexcept;

  HidOpener open_;
  HidClient& client_;
  HidStreamSettings settings_;

  std::unique_ptr<HidPort> port_;
  std::atomic<bool> is_connected_{false}, is_gone_{false};
  std::atomic<std::uint64_t> reports_{0}, refused_{0}, written_{0}, write_misses_{0};
  std::thread writer_;
  DeviceThread reader_;  ///< last, because the thread uses the members above
};

}  // namespace tandem
