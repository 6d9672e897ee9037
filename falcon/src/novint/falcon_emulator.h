#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <random>

#include "tandem/falcon/byte_transport.h"

#include "novint/falcon_frames.h"
#include "novint/falcon_plant.h"
#include "novint/firmware_image.h"

namespace tandem {

/// Faults to inject. Each number is how many of the next events fail: 0 none, kAlways all.
struct FalconMishaps {
  static constexpr int kAlways = std::numeric_limits<int>::max();

  int silent_calls = 0;   ///< calls that the boot loader does not answer
  int wrong_loads = 0;    ///< boots in which byte `load_byte` of the image is echoed wrong
  int stopped_loads = 0;  ///< boots in which the echo stops at `load_byte`
  std::size_t load_byte = 0;
  int dead_starts = 0;  ///< boots after which no firmware runs

  int silent_replies = 0;
  int short_replies = 0;     ///< replies of 14 bytes
  int lost_bytes = 0;        ///< replies that lose one byte
  int doubled_bytes = 0;     ///< replies with one byte doubled
  int turned_bits = 0;       ///< replies with one bit flipped
  int strange_replies = 0;   ///< replies whose byte 14 is not 'A'
  int split_replies = 0;     ///< replies sent in two pieces
  double split_time = 0.0;   ///< time between the two pieces [s]
  double reply_delay = 0.0;  ///< delay of every reply [s]
  int stuck_leg = -1;        ///< leg whose encoder stopped counting; -1: none
};

/// Effect of motor commands beyond +-4095. The effect in a real device is not known.
enum class FalconOverrange : std::uint8_t {
  kClamp,   ///< the motors do all they can; the belief
  kIgnore,  ///< the frame is not answered and the last force stays; worse for a host
};

struct FalconEmulatorSettings {
  FalconPlantSettings plant;
  std::uint64_t seed = 1;          ///< of the encoder offsets before homing, and of the mishaps
  bool runs = false;               ///< starts with running firmware
  bool is_homed = false;           ///< starts with all legs homed; needs `runs`
  bool has_modem_lines = true;     ///< false: ignores DTR, as over a pseudo terminal
  bool answers_with_zero = false;  ///< sends 00 before the boot loader's answer, as some stacks do
  bool echoes_with_dc3 = false;    ///< sends 13 before the echo of 'A', as some stacks do
  bool has_usb_times = false;      ///< bytes come at the latency timer's ticks; false: at once
  FalconOverrange overrange = FalconOverrange::kClamp;
  bool always_tells_homed = false;  ///< tells the homed legs outside of homing mode, too
  double watchdog = 0.0;            ///< without frames the motors rest after this [s]; 0: never
};

/// Forces that the hand at an emulated device has felt.
struct FalconFelt {
  double most_force = 0.0;   ///< largest force [N]
  double most_change = 0.0;  ///< largest change from one frame to the next [N]
  double most_rise = 0.0;    ///< largest growth of the force from one frame to the next [N]
  double most_slew = 0.0;    ///< the change per time between the frames, at least 1 ms [N/s]
  double pushed_at = -1.0;   ///< last time with a force above 0.01 N [s]
};

/// A Novint Falcon in software, byte by byte: boot loader, firmware and mechanism. It is written
/// from facts about the protocol and contains nothing of Novint's. The caller passes the time,
/// which must not run back. Equal calls give equal bits. Not thread safe.
///
///     off -- power --> waiting -- 9600, DTR rises --> calling -- 0A 43 0D -->
///     timing -- 'A' at 140000 --> loading -- end of the boot table -->
///     running (1.5 MBd: a reply to each command)
class FalconEmulator {
 public:
  enum class State : std::uint8_t { kOff, kWaiting, kCalling, kTiming, kLoading, kRunning };

  /// Throws std::invalid_argument as FalconPlant does. `hand` may be null.
  explicit FalconEmulator(const FalconEmulatorSettings& settings = {},
                          std::unique_ptr<Hand> hand = nullptr);

  // The line.
  void setLine(const SerialLine& line) noexcept;
  void take(const std::uint8_t* bytes, std::size_t count, double now);
  /// Takes up to `room` bytes that the device has sent by `now`.
  [[nodiscard]] std::size_t collect(std::uint8_t* bytes, std::size_t room, double now) noexcept;
  void purge() noexcept { out_.clear(); }
  [[nodiscard]] bool isPluggedIn() const noexcept { return is_plugged_in_; }

  // Events from outside.
  FalconMishaps mishaps;
  void switchOff(double now) noexcept;
  void switchOn(double now) noexcept;
  /// Loses the homing: the legs must pass their index marks again.
  void loseHoming() noexcept { homed_ = 0; }
  void plugIn(bool is_in) noexcept;
  void press(std::uint8_t buttons) noexcept { buttons_ = buttons; }

  /// Advances the mechanism, as every call with a time does.
  void advance(double now) noexcept;
  [[nodiscard]] FalconPlant& plant() noexcept { return plant_; }
  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] std::uint8_t homed() const noexcept { return homed_; }
  [[nodiscard]] const FalconCommand& command() const noexcept { return command_; }  ///< last one
  [[nodiscard]] const FalconFelt& felt() const noexcept { return felt_; }
  [[nodiscard]] std::uint64_t commands() const noexcept { return commands_; }
  /// Number of frames beyond what is known of commands: motors out of range, unknown bits.
  [[nodiscard]] std::uint64_t strange() const noexcept { return strange_; }

 private:
  struct Byte {
    double at;
    std::uint8_t byte;
  };

  void takeByte(std::uint8_t byte, double now);
  void takeCall(std::uint8_t byte, double now);
  void takeImage(std::uint8_t byte, double now);
  void takeFrame(const FalconFrame& frame, double now);
  void takeCommand(const FalconCommand& command, double now);
  void feel(const Vec3& before_D, double now) noexcept;
  void findIndices() noexcept;
  void sendReply(double now);
  [[nodiscard]] std::array<std::int16_t, 3> countNow() noexcept;
  void send(const std::uint8_t* bytes, std::size_t count, double at);
  [[nodiscard]] double arrivalOf(double at) const noexcept;
  [[nodiscard]] std::size_t draw(std::size_t below);

  FalconEmulatorSettings settings_;
  FalconPlant plant_;
  std::mt19937_64 random_;
  State state_ = State::kWaiting;
  bool is_plugged_in_ = true;
  SerialLine line_;
  std::deque<Byte> out_;

  std::array<std::uint8_t, 3> call_{};  ///< last bytes, the newest last
  bool is_called_ = false;
  bool is_wrong_load_ = false, is_stopped_load_ = false;
  BootTableReader table_;

  FalconFrameReader frames_;
  FalconCommand command_;
  FalconFelt felt_;
  std::uint8_t homed_ = 0, buttons_ = 0;
  std::uint64_t commands_ = 0, strange_ = 0;
  double commanded_at_ = 0.0;
  Vec3 angles_;                           ///< at the last search for index marks
  std::array<std::int16_t, 3> counts_{};  ///< at the last reply; repeated by a stuck encoder
  std::array<int, 3> offsets_{};          ///< encoder offsets before homing
};

}  // namespace tandem
