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

/// An emulated Falcon behind a pseudo terminal, served by a thread in real time: any program that
/// opens a tty meets it. Pseudo terminals have no DTR, so the emulator does without. Linux.
class EmulatedFalconPort {
 public:
  /// `thread_priority`: SCHED_FIFO where it is granted, as a real device waits for no processor; 0:
  /// as the process has it. Throws tandem::Error without pseudo terminals or a folder for temporary
  /// files, std::invalid_argument as FalconEmulator does.
  explicit EmulatedFalconPort(const FalconEmulatorSettings& settings,
                              std::unique_ptr<Hand> hand = nullptr, int thread_priority = 0);
  /// With the emulator's default settings.
  explicit EmulatedFalconPort(std::unique_ptr<Hand> hand = nullptr);
  ~EmulatedFalconPort();
  EmulatedFalconPort(const EmulatedFalconPort&) = delete;
  EmulatedFalconPort& operator=(const EmulatedFalconPort&) = delete;

  /// What to open: a link that stays while what it leads to changes, as /dev/serial/by-id does.
  [[nodiscard]] const std::string& path() const noexcept;

  /// The line goes away as if the cable were pulled, and comes back, or throws as above. The device
  /// keeps its power.
  void unplug();
  void plugIn();

  /// Looks at the emulator, or does something to it, at the emulator's time [s]; its thread waits.
  void visit(const std::function<void(FalconEmulator&, double now)>& visitor);

  /// What the motors push the grip with now, in the device's frame [N].
  [[nodiscard]] Vec3 readForce();
  /// The most that they ever did [N].
  [[nodiscard]] double readMostForce();

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

/// A line to an emulator in this program, without pseudo terminal: for one thread, in which the
/// emulator then runs in real time. The emulator must outlive it.
[[nodiscard]] std::unique_ptr<ByteTransport> openEmulator(FalconEmulator& emulator);

}  // namespace tandem
#pragma GCC visibility pop
