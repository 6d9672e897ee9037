#pragma once

#include <functional>
#include <memory>
#include <string>

#include "tandem/coordination/types.h"
#include "tandem/falcon/simulated_device.h"

#pragma GCC visibility push(default)
namespace tandem {

class ByteTransport;
class FalconEmulator;
struct FalconEmulatorSettings;

/// An emulated Falcon behind a pseudo terminal, served in real time by its own thread. Any program
/// that opens a tty can use it. Pseudo terminals have no DTR, so the emulator ignores DTR. Linux
/// only.
class EmulatedFalconPort {
 public:
  /// `thread_priority` is the SCHED_FIFO priority, where the system grants it; 0 keeps the
  /// scheduling of the process. Real-time priority helps because a real device never waits for a
  /// processor. Throws tandem::Error if there are no pseudo terminals or no temporary folder.
  /// Throws std::invalid_argument as FalconEmulator does.
  explicit EmulatedFalconPort(const FalconEmulatorSettings& settings,
                              std::unique_ptr<Hand> hand = nullptr, int thread_priority = 0);
  /// Uses the emulator's default settings.
  explicit EmulatedFalconPort(std::unique_ptr<Hand> hand = nullptr);
  ~EmulatedFalconPort();
  EmulatedFalconPort(const EmulatedFalconPort&) = delete;
  EmulatedFalconPort& operator=(const EmulatedFalconPort&) = delete;

  /// Path to open: a symbolic link that stays the same while its target changes, like
  /// /dev/serial/by-id.
  [[nodiscard]] const std::string& path() const noexcept;

  /// Removes the line as if the cable were pulled, and brings it back. The device keeps its power.
  /// plugIn() throws like the constructor.
  void unplug();
  void plugIn();

  /// Calls `visitor` with the emulator and its time [s]. The emulator's thread waits meanwhile.
  void visit(const std::function<void(FalconEmulator&, double now)>& visitor);

  /// Force of the motors on the grip now, in the device's frame [N].
  [[nodiscard]] Vec3 readForce();
  /// Largest norm of that force so far [N].
  [[nodiscard]] double readMostForce();

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

/// Opens a line to an emulator in this program, without a pseudo terminal. For one thread only: the
/// emulator runs in that thread, in real time. The emulator must outlive the line.
[[nodiscard]] std::unique_ptr<ByteTransport> openEmulator(FalconEmulator& emulator);

}  // namespace tandem
#pragma GCC visibility pop
