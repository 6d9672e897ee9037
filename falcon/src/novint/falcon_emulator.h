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

#pragma GCC visibility push(default)
namespace tandem {

/// What can go wrong. Numbers say how many of the next ones do: 0 none, kAlways all.
struct FalconMishaps {
  static constexpr int kAlways = std::numeric_limits<int>::max();

  int silent_calls = 0;   ///< calls that the boot loader does not answer
  int wrong_loads = 0;    ///< boots in which byte `load_byte` of the image is echoed wrong
  int stopped_loads = 0;  ///< boots in which the echo stops there
  std::size_t load_byte = 0;
  int dead_starts = 0;  ///< boots after which nothing runs

  int silent_replies = 0;
  int short_replies = 0;     ///< 14 bytes
  int lost_bytes = 0;        ///< replies that lose a byte somewhere
  int doubled_bytes = 0;     ///< replies with a byte twice
  int turned_bits = 0;       ///< replies with one bit turned
  int strange_replies = 0;   ///< whose byte 14 is not 'A'
  int split_replies = 0;     ///< in two pieces...
  double split_time = 0.0;   ///< ...so far apart [s]
  double reply_delay = 0.0;  ///< of all [s]
  int stuck_leg = -1;        ///< whose encoder does not count any more
};

struct FalconEmulatorSettings {
  FalconPlantSettings plant;
  std::uint64_t seed = 1;          ///< of the encoders' counts before homing, and of mishaps
  bool runs = false;               ///< its firmware is there from before
  bool is_homed = false;           ///< ... and its legs have found their indices
  bool has_modem_lines = true;     ///< false: DTR does not matter, as over a pseudo terminal
  bool answers_with_zero = false;  ///< 00 before the boot loader's answer, as some stacks see it
  bool echoes_with_dc3 = false;    ///< 13 before the echo of 'A', likewise
  bool has_usb_times = false;      ///< bytes come at the latency timer's ticks; false: at once
  double watchdog = 0.0;  ///< without frames the motors rest after this [s]; 0: never. Whether a
                          ///< real one has that is not known
};

/// What the hand at an emulated device has felt.
struct FalconFelt {
  double most_force = 0.0;   ///< [N]
  double most_change = 0.0;  ///< from one frame to the next [N]
  double most_slew = 0.0;    ///< the same by the time between, 1 ms at least [N/s]
  double pushed_at = -1.0;   ///< the last time that there was force, above 0.01 N [s]
};

/// A Novint Falcon made of software, byte by byte: boot loader, firmware and mechanism. Written
/// from facts about the protocol; it holds nothing of Novint's. Time is told and does not run back;
/// equal calls give equal bits. Not thread safe.
///
///     off -- power --> waiting -- 9600, DTR rises --> calling -- 0A 43 0D --> timing -- 'A' at
///     140000 --> loading -- end of the boot table --> running (1.5 MBd: a reply to each command)
class FalconEmulator {
 public:
  enum class State : std::uint8_t { kOff, kWaiting, kCalling, kTiming, kLoading, kRunning };

  /// Throws std::invalid_argument as FalconPlant does. `hand` may be null.
  explicit FalconEmulator(const FalconEmulatorSettings& settings = {},
                          std::unique_ptr<Hand> hand = nullptr);

  // The line.
  void setLine(const SerialLine& line) noexcept;
  void take(const std::uint8_t* bytes, std::size_t count, double now);
  /// What it has sent by now, up to `room` bytes.
  [[nodiscard]] std::size_t collect(std::uint8_t* bytes, std::size_t room, double now) noexcept;
  void purge() noexcept { out_.clear(); }
  [[nodiscard]] bool isPluggedIn() const noexcept { return is_plugged_in_; }

  // What happens to it.
  FalconMishaps mishaps;
  void switchOff(double now) noexcept;
  void switchOn(double now) noexcept;
  /// Homing is lost: the legs must find their indices again.
  void loseHoming() noexcept { homed_ = 0; }
  void plugIn(bool is_in) noexcept;
  void press(std::uint8_t buttons) noexcept { buttons_ = buttons; }

  /// Moves its mechanism on, as every other call with a time does.
  void advance(double now) noexcept;
  [[nodiscard]] FalconPlant& plant() noexcept { return plant_; }
  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] std::uint8_t homed() const noexcept { return homed_; }
  [[nodiscard]] const FalconCommand& command() const noexcept { return command_; }  ///< the last
  [[nodiscard]] const FalconFelt& felt() const noexcept { return felt_; }
  [[nodiscard]] std::uint64_t commands() const noexcept { return commands_; }
  /// Frames that are no command: motors out of range, unknown bits.
  [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }

 private:
  struct Byte {
    double at;
    std::uint8_t byte;
  };

  void takeByte(std::uint8_t byte, double now);
  void takeCall(std::uint8_t byte, double now);
  void takeImage(std::uint8_t byte, double now);
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

  std::array<std::uint8_t, 3> call_{};  ///< bytes, the newest last
  bool is_called_ = false;
  bool is_wrong_load_ = false, is_stopped_load_ = false;
  BootTableReader table_;

  FalconFrameReader frames_;
  FalconCommand command_;
  FalconFelt felt_;
  std::uint8_t homed_ = 0, buttons_ = 0;
  std::uint64_t commands_ = 0, refused_ = 0;
  double commanded_at_ = 0.0;
  Vec3 angles_;                           ///< at the last look, for the indices
  std::array<std::int16_t, 3> counts_{};  ///< at the last reply, for an encoder that is stuck
  std::array<int, 3> offsets_{};          ///< of the encoders, before homing
};

}  // namespace tandem
#pragma GCC visibility pop
