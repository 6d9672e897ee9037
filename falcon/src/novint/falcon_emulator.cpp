#include "novint/falcon_emulator.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tandem {
namespace {

constexpr std::array<std::uint8_t, 3> kCall = {0x0A, 0x43, 0x0D};
constexpr std::array<std::uint8_t, 5> kAnswer = {0x00, 0x0A, 0x44, 0x2C, 0x0D};
constexpr std::array<std::uint8_t, 2> kTimed = {0x13, 'A'};

constexpr double kIndexCounts = 400.0;  // count of the index mark, near the middle
constexpr int kMostOffset = 1500;       // largest offset before homing [counts]
constexpr double kFelt = 0.01;          // smallest force that counts as felt [N]
constexpr double kUsbFrame = 0.001;     // [s]
constexpr double kBaudSlack = 0.025;    // largest relative error of a usable speed

/// Speed that the FTDI chip makes when a host asks for `baud`: 3 MHz by a number of eighths from 2
/// on, or by 1.5 or 1; the nearest of these.
int computeChipSpeed(int baud) noexcept {
  constexpr double kEighths = 8.0 * 3e6;
  if (baud <= 0) return 0;
  const double divisor = std::round(kEighths / baud);
  if (divisor < 14.0) return divisor < 10.0 ? 3'000'000 : 2'000'000;
  return static_cast<int>(kEighths / std::max(divisor, 16.0));
}

bool isNear(int baud, int wanted) noexcept {
  return std::abs(computeChipSpeed(baud) - wanted) <= kBaudSlack * wanted;
}

/// Uses up one of `count` pending mishaps. Returns false if none is pending.
bool use(int& count) noexcept {
  if (count <= 0) return false;
  if (count != FalconMishaps::kAlways) --count;
  return true;
}

}  // namespace

FalconEmulator::FalconEmulator(const FalconEmulatorSettings& settings, std::unique_ptr<Hand> hand)
    : settings_(settings),
      plant_(settings.plant, std::move(hand)),
      random_(settings.seed),
      angles_(plant_.angles()) {
  line_.baud = 0;
  if (settings.runs) state_ = State::kRunning;
  if (settings.runs && settings.is_homed) homed_ = 7;
  for (int& offset : offsets_) offset = static_cast<int>(draw(2 * kMostOffset + 1)) - kMostOffset;
}

std::size_t FalconEmulator::draw(std::size_t below) { return random_() % below; }

void FalconEmulator::setLine(const SerialLine& line) noexcept {
  const bool is_reset =
      settings_.has_modem_lines ? line.dtr && !line_.dtr : line.baud != line_.baud;
  const bool may_time = !settings_.has_modem_lines || !line.dtr;
  line_ = line;
  if (state_ == State::kOff || state_ == State::kRunning) return;
  if (isNear(line.baud, 9600) && is_reset) {
    state_ = State::kCalling;
    is_called_ = false;
    call_ = {};
  } else if (isNear(line.baud, 140000) && may_time && state_ == State::kCalling && is_called_) {
    state_ = State::kTiming;
  }
}

void FalconEmulator::take(const std::uint8_t* bytes, std::size_t count, double now) {
  advance(now);
  for (std::size_t i = 0; is_plugged_in_ && i < count; ++i) takeByte(bytes[i], now);
}

void FalconEmulator::takeByte(std::uint8_t byte, double now) {
  switch (state_) {
    case State::kOff:
    case State::kWaiting:
      break;
    case State::kCalling:
      if (isNear(line_.baud, 9600)) takeCall(byte, now);
      break;
    case State::kTiming:
      if (byte != 'A' || !isNear(line_.baud, 140000)) break;
      state_ = State::kLoading;
      table_ = {};
      is_wrong_load_ = use(mishaps.wrong_loads);
      is_stopped_load_ = !is_wrong_load_ && use(mishaps.stopped_loads);
      if (settings_.echoes_with_dc3)
        send(kTimed.data(), 2, now);
      else
        send(&byte, 1, now);
      break;
    case State::kLoading:
      if (isNear(line_.baud, 140000)) takeImage(byte, now);
      break;
    case State::kRunning:
      if (!isNear(line_.baud, 1500000)) break;
      if (const auto frame = frames_.take(byte)) takeFrame(*frame, now);
      break;
  }
}

void FalconEmulator::takeCall(std::uint8_t byte, double now) {
  call_ = {call_[1], call_[2], byte};
  if (call_ != kCall) return;
  if (use(mishaps.silent_calls)) return;
  is_called_ = true;
  const std::size_t skipped = settings_.answers_with_zero ? 0 : 1;
  send(kAnswer.data() + skipped, kAnswer.size() - skipped, now);
}

void FalconEmulator::takeImage(std::uint8_t byte, double now) {
  const std::size_t number = table_.bytes();
  const BootTableReader::State state = table_.take(byte);
  if (table_.isWrong() || (is_stopped_load_ && number == mishaps.load_byte)) {
    state_ = State::kWaiting;
    return;
  }
  if (is_wrong_load_ && number == mishaps.load_byte) byte ^= 0x10;
  send(&byte, 1, now);
  if (state != BootTableReader::State::kDone) return;
  state_ = use(mishaps.dead_starts) ? State::kWaiting : State::kRunning;
  frames_.clear();
}

void FalconEmulator::takeFrame(const FalconFrame& frame, double now) {
  FalconCommand command = readCommand(frame);
  if (!decodeCommand(frame)) ++strange_;
  const FalconMotors wanted = command.motors;
  for (std::int16_t& motor : command.motors)
    motor = std::clamp<std::int16_t>(motor, -kMostMotor, kMostMotor);
  if (command.motors != wanted && settings_.overrange == FalconOverrange::kIgnore) return;
  takeCommand(command, now);
}

void FalconEmulator::takeCommand(const FalconCommand& command, double now) {
  ++commands_;
  const Vec3 before_D = plant_.force();
  command_ = command;
  plant_.setMotors(command.motors);
  feel(before_D, now);
  commanded_at_ = now;
  sendReply(now);
}

void FalconEmulator::feel(const Vec3& before_D, double now) noexcept {
  const Vec3 after_D = plant_.force();
  const double change = (after_D - before_D).norm();
  felt_.most_force = std::max(felt_.most_force, after_D.norm());
  felt_.most_change = std::max(felt_.most_change, change);
  felt_.most_rise = std::max(felt_.most_rise, after_D.norm() - before_D.norm());
  felt_.most_slew = std::max(felt_.most_slew, change / std::max(now - commanded_at_, kUsbFrame));
}

void FalconEmulator::advance(double now) noexcept {
  plant_.advance(now);
  findIndices();
  const double force = plant_.force().norm();
  felt_.most_force = std::max(felt_.most_force, force);
  if (force > kFelt) felt_.pushed_at = now;
  if (settings_.watchdog > 0.0 && now - commanded_at_ > settings_.watchdog) plant_.setMotors({});
}

/// A leg is homed when it passes its index mark while the host asks for homing.
void FalconEmulator::findIndices() noexcept {
  const double index = angleOfCounts(kIndexCounts);
  const Vec3 before = std::exchange(angles_, plant_.angles());
  if (state_ != State::kRunning || !command_.homes) return;
  for (Eigen::Index i = 0; i < 3; ++i)
    if ((before[i] < index) != (angles_[i] < index))
      homed_ = static_cast<std::uint8_t>(homed_ | (1U << i));
}

std::array<std::int16_t, 3> FalconEmulator::countNow() noexcept {
  std::array<std::int16_t, 3> counts{};
  for (std::size_t i = 0; i < 3; ++i) {
    const bool is_homed = (homed_ >> i & 1) != 0;
    const double count = std::round(countsOfAngle(plant_.angles()[static_cast<Eigen::Index>(i)]));
    counts[i] = static_cast<int>(i) == mishaps.stuck_leg
                    ? counts_[i]
                    : static_cast<std::int16_t>(count + (is_homed ? 0 : offsets_[i]));
  }
  return counts_ = counts;
}

void FalconEmulator::sendReply(double now) {
  FalconReply reply;
  reply.counts = countNow();
  reply.buttons = buttons_;
  if (command_.homes || settings_.always_tells_homed) reply.homed = homed_;
  const FalconFrame frame = encodeReply(reply);
  std::array<std::uint8_t, kFalconFrameSize + 1> bytes{};
  std::copy(frame.begin(), frame.end(), bytes.begin());
  std::size_t count = frame.size();

  if (use(mishaps.silent_replies)) return;
  if (use(mishaps.strange_replies)) bytes[14] = static_cast<std::uint8_t>('A' + draw(60));
  if (use(mishaps.turned_bits)) bytes[draw(count)] ^= static_cast<std::uint8_t>(1U << draw(8));
  if (use(mishaps.short_replies)) count = 14;
  if (use(mishaps.lost_bytes)) {
    const auto lost = bytes.begin() + static_cast<std::ptrdiff_t>(draw(count));
    std::copy(lost + 1, bytes.end(), lost);
    --count;
  }
  if (use(mishaps.doubled_bytes)) {
    const auto doubled = static_cast<std::ptrdiff_t>(draw(count));
    std::copy_backward(bytes.begin() + doubled, bytes.begin() + static_cast<std::ptrdiff_t>(count),
                       bytes.begin() + static_cast<std::ptrdiff_t>(count) + 1);
    ++count;
  }
  const bool is_split = use(mishaps.split_replies);
  const std::size_t first = is_split ? 1 + draw(count - 1) : count;
  const double at = now + mishaps.reply_delay;
  send(bytes.data(), first, at);
  if (is_split) send(bytes.data() + first, count - first, at + mishaps.split_time);
}

/// Arrival time of bytes sent at `at` [s]: the FTDI chip sends at the next tick of its latency
/// timer.
double FalconEmulator::arrivalOf(double at) const noexcept {
  if (!settings_.has_usb_times) return at;
  const double on_line = at + 2.0 * 10.0 * kFalconFrameSize / std::max(line_.baud, 1);
  const double tick = kUsbFrame * std::max(line_.latency_ms, 1);
  return tick * std::ceil(on_line / tick);
}

void FalconEmulator::send(const std::uint8_t* bytes, std::size_t count, double at) {
  double arrival = arrivalOf(at);
  if (!out_.empty()) arrival = std::max(arrival, out_.back().at);
  for (std::size_t i = 0; i < count; ++i) out_.push_back({arrival, bytes[i]});
}

std::size_t FalconEmulator::collect(std::uint8_t* bytes, std::size_t room, double now) noexcept {
  advance(now);
  std::size_t count = 0;
  for (; count < room && !out_.empty() && out_.front().at <= now; out_.pop_front())
    bytes[count++] = out_.front().byte;
  return count;
}

void FalconEmulator::switchOff(double now) noexcept {
  advance(now);
  state_ = State::kOff;
  homed_ = 0;
  command_ = {};
  plant_.setMotors({});
  out_.clear();
}

void FalconEmulator::switchOn(double now) noexcept {
  advance(now);
  if (state_ != State::kOff) return;
  state_ = State::kWaiting;
  frames_.clear();
  line_.baud = 0;
  for (int& offset : offsets_) offset = static_cast<int>(draw(2 * kMostOffset + 1)) - kMostOffset;
}

void FalconEmulator::plugIn(bool is_in) noexcept {
  is_plugged_in_ = is_in;
  out_.clear();
}

}  // namespace tandem
