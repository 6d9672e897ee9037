#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "tandem/falcon/hid_port.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Whose reports a HidStream carries. Reports that tell changes only (a SpaceMouse tells places and
/// turns in turn) must all be seen: they are taken on the reader's thread, and what they add up to
/// is published from there.
class HidClient {
 public:
  virtual ~HidClient() = default;

  /// On the reader's thread: an input report that came at `now` [s] of the stream's clock. False:
  /// the device cannot have meant it; it is counted.
  [[nodiscard]] virtual bool takeReport(const std::uint8_t* report, std::size_t size,
                                        double now) noexcept = 0;

  /// On the writer's thread, once in a write period: what to send now; size 0: nothing.
  [[nodiscard]] virtual HidReport giveReport(double now) noexcept;

  /// On the writer's thread, six times at least a millisecond apart before the port is closed,
  /// whether the device is still there or not: the way to motors off. Size 0: nothing.
  [[nodiscard]] virtual HidReport giveLastReport(double now) noexcept;

  /// The device has come, or has gone. Never together with takeReport(); there is no writer's
  /// thread while it comes, while it goes there is.
  virtual void setConnected(bool is_connected) noexcept = 0;
};

/// The same for a device that is only read.
[[nodiscard]] HidStreamSettings withoutWriting(HidStreamSettings settings) noexcept;

/// Carries reports between a HID device and its client, by a thread that reads and one that writes:
/// a write to a HID device takes 0.3 ms, at times 14 ms, and no haptic tick may wait for it. Opens
/// the device again by itself after it was unplugged.
class HidStream {
 public:
  /// Opens the device, or throws what `open` throws, tandem::Error if it gives none. Throws
  /// std::invalid_argument for settings out of range. The client must outlive the stream.
  HidStream(HidOpener open, HidClient& client, const HidStreamSettings& settings = {});
  /// Says the last words, waits for both threads.
  ~HidStream();
  HidStream(const HidStream&) = delete;
  HidStream& operator=(const HidStream&) = delete;

  /// Wait-free, for any thread.
  [[nodiscard]] bool isConnected() const noexcept { return is_connected_; }
  [[nodiscard]] HidStreamCounters counters() const noexcept;

  /// What the device is called, and why it could not be opened again ("" if it could). Not for the
  /// haptic thread.
  [[nodiscard]] std::string name() const;
  [[nodiscard]] std::string trouble() const;

 private:
  void connect();
  void startWriter();
  [[nodiscard]] bool reconnect() noexcept;
  void disconnect() noexcept;
  void run() noexcept;
  void readUntilGone() noexcept;
  void writeUntilGone() noexcept;
  void sayLastWords() noexcept;
  void send(const HidReport& report) noexcept;
  /// False if the stream ends meanwhile.
  [[nodiscard]] bool sleep(double time) noexcept;

  HidOpener open_;
  HidClient& client_;
  HidStreamSettings settings_;

  std::unique_ptr<HidPort> port_;
  std::atomic<bool> is_connected_{false}, is_gone_{false}, is_ending_{false};
  std::atomic<std::uint64_t> reports_{0}, refused_{0}, written_{0}, write_misses_{0}, losses_{0};

  mutable std::mutex mutex_;  ///< of the texts and of the end
  std::condition_variable ends_;
  std::string name_, trouble_;
  std::thread reader_, writer_;
};

}  // namespace tandem
#pragma GCC visibility pop
