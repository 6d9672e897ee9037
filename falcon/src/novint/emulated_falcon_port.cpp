#include "tandem/falcon/emulated_falcon_port.h"

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "tandem/coordination/types.h"
#include "tandem/falcon/monotonic_clock.h"

#include "guard/realtime_rights.h"
#include "novint/falcon_emulator.h"
#include "novint/pseudo_terminal.h"

namespace tandem {
namespace {

constexpr double kLook = 0.0002;    // interval between checks for bytes to send [s]
constexpr double kVisit = 0.00002;  // pause while a visitor waits for the lock [s]
constexpr double kNap = 0.002;      // pause while the port is unplugged [s]

/// A symbolic link in a private folder, so that no other program can replace it. The destructor
/// removes both.
class PrivateSymlink {
 public:
  PrivateSymlink() {
    std::error_code error;
    const std::filesystem::path parent = std::filesystem::temp_directory_path(error);
    std::string folder = (parent / "tandem-falcon-XXXXXX").string();
    if (error || ::mkdtemp(folder.data()) == nullptr)
      throw Error(
          "no folder can be made for the line of an emulated Falcon; set TMPDIR to "
          "one that may be written to");
    folder_ = folder;
    path_ = folder + "/tty";
  }
  ~PrivateSymlink() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  PrivateSymlink(const PrivateSymlink&) = delete;
  PrivateSymlink& operator=(const PrivateSymlink&) = delete;

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  void leadTo(const std::string& target) {
    std::error_code error;
    std::filesystem::remove(path_, error);
    std::filesystem::create_symlink(target, path_, error);
    if (error) throw Error(path_ + ": cannot be made (" + error.message() + "); is the disk full?");
  }
  void remove() noexcept {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }

 private:
  std::filesystem::path folder_;
  std::string path_;
};

FalconEmulatorSettings withoutModemLines(FalconEmulatorSettings settings) {
  settings.has_modem_lines = false;
  return settings;
}

}  // namespace

class EmulatedFalconPort::Server {
 public:
  Server(const FalconEmulatorSettings& settings, std::unique_ptr<Hand> hand, int priority)
      : emulator_(withoutModemLines(settings), std::move(hand)), priority_(priority) {
    plugIn();
    thread_ = std::thread([this] { run(); });
  }

  ~Server() {
    stops_.store(true, std::memory_order_relaxed);
    thread_.join();
  }

  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] const std::string& path() const noexcept { return link_.path(); }

  void plugIn() {
    ++visitors_;
    const std::lock_guard lock(mutex_);
    --visitors_;
    terminal_.emplace();
    emulator_.plugIn(true);
    link_.leadTo(terminal_->path());
  }

  void unplug() {
    ++visitors_;
    const std::lock_guard lock(mutex_);
    --visitors_;
    link_.remove();
    terminal_.reset();
    emulator_.plugIn(false);
    line_.baud = 0;
  }

  void visit(const std::function<void(FalconEmulator&, double)>& visitor) {
    ++visitors_;
    const std::lock_guard lock(mutex_);
    --visitors_;
    const double now = readMonotonicClock();
    emulator_.advance(now);
    visitor(emulator_, now);
  }

 private:
  void run() {
    RealtimeRights rights;
    rights.take(priority_, false);
    while (!stops_.load(std::memory_order_relaxed)) {
      if (!serve()) sleepFor(kNap);
      while (visitors_.load() > 0) sleepFor(kVisit);  // visitors get the lock first
    }
  }

  /// Exchanges bytes once. Returns false while there is no line.
  bool serve() {
    const std::lock_guard lock(mutex_);
    if (!terminal_) return false;
    std::array<std::uint8_t, 256> bytes;
    const std::size_t come = terminal_->read(bytes.data(), bytes.size(), kLook);
    // Read the speed after the bytes: a host sets it before it sends.
    if (const int baud = terminal_->readSpeed(); baud != line_.baud && baud > 0) {
      line_.baud = baud;
      emulator_.setLine(line_);
    }
    emulator_.take(bytes.data(), come, readMonotonicClock());
    const std::size_t left = emulator_.collect(bytes.data(), bytes.size(), readMonotonicClock());
    if (left > 0) terminal_->write(bytes.data(), left);
    return true;
  }

  std::mutex mutex_;
  FalconEmulator emulator_;
  PrivateSymlink link_;
  std::optional<falcon_detail::PseudoTerminal> terminal_;
  SerialLine line_;
  std::atomic<bool> stops_{false};
  std::atomic<int> visitors_{0};
  int priority_;
  std::thread thread_;
};

EmulatedFalconPort::EmulatedFalconPort(const FalconEmulatorSettings& settings,
                                       std::unique_ptr<Hand> hand, int thread_priority)
    : server_(std::make_unique<Server>(settings, std::move(hand), thread_priority)) {}
EmulatedFalconPort::EmulatedFalconPort(std::unique_ptr<Hand> hand)
    : EmulatedFalconPort(FalconEmulatorSettings{}, std::move(hand)) {}
EmulatedFalconPort::~EmulatedFalconPort() = default;

const std::string& EmulatedFalconPort::path() const noexcept { return server_->path(); }
void EmulatedFalconPort::unplug() { server_->unplug(); }
void EmulatedFalconPort::plugIn() { server_->plugIn(); }
void EmulatedFalconPort::visit(const std::function<void(FalconEmulator&, double now)>& visitor) {
  server_->visit(visitor);
}

Vec3 EmulatedFalconPort::readForce() {
  Vec3 force_D = Vec3::Zero();
  visit([&](FalconEmulator& emulator, double) { force_D = emulator.plant().force(); });
  return force_D;
}

double EmulatedFalconPort::readMostForce() {
  double most = 0.0;
  visit([&](FalconEmulator& emulator, double) { most = emulator.felt().most_force; });
  return most;
}

namespace {

class EmulatorLine final : public ByteTransport {
 public:
  explicit EmulatorLine(FalconEmulator& emulator) : emulator_(emulator) {}

  [[nodiscard]] const std::string& name() const noexcept override { return name_; }
  [[nodiscard]] bool write(const std::uint8_t* bytes, std::size_t count) noexcept override {
    emulator_.take(bytes, count, readMonotonicClock());
    return emulator_.isPluggedIn();
  }
  [[nodiscard]] std::ptrdiff_t read(std::uint8_t* bytes, std::size_t room,
                                    double wait) noexcept override {
    const double until = readMonotonicClock() + wait;
    for (;;) {
      if (!emulator_.isPluggedIn()) return -1;
      const double now = readMonotonicClock();
      const std::size_t count = emulator_.collect(bytes, room, now);
      if (count > 0 || now >= until) return static_cast<std::ptrdiff_t>(count);
      sleepFor(kLook);
    }
  }
  [[nodiscard]] bool setLine(const SerialLine& line) noexcept override {
    emulator_.setLine(line);
    return emulator_.isPluggedIn();
  }
  void purge() noexcept override { emulator_.purge(); }

 private:
  FalconEmulator& emulator_;
  std::string name_ = "emulated Falcon";
};

}  // namespace

std::unique_ptr<ByteTransport> openEmulator(FalconEmulator& emulator) {
  return std::make_unique<EmulatorLine>(emulator);
}

}  // namespace tandem
