#include "wire/wire_state.h"

#include <algorithm>
#include <cmath>

#include "wire/byte_reader.h"
#include "wire/byte_writer.h"
#include "wire/state_gate.h"

//   0 send_time_us i64 | state_time_us i64 | state_sequence u64 | echo_send_time_us i64
//  32 echo_hold_us u32 | ack_bits u32 | granted f64 | holdings f64
//  56 flags u16 | profile u8 | objects u8 | config_hash u32 | DEVICE {p, v} | GRIP {epoch
//  u16, object u16, age_us u32, p, q} with the flag | ROLL {heard u64, members u64, age_ms u32}
//  with its flag | OBJECT {id u16, epoch_author u8, zero u8, epoch u32, p, q, v, w} ...
namespace tandem {
namespace {

/// Object of a grip that holds none.
constexpr std::uint16_t kNoObject = 0xffff;

/// An age in whole parts of a second; the most that fits stands for more.
std::uint32_t toAge(double parts) noexcept {
  return static_cast<std::uint32_t>(std::min(parts, 4294967295.0));
}

/// Whole parts that have passed. An age that came in whole parts keeps them.
double roundDown(double parts) noexcept { return std::floor(parts + 1e-6); }

/// Writes numbers in a profile's width. Values that passed the gate round to finite floats.
template <class Real>
class RecordWriter {
 public:
  explicit RecordWriter(wire::ByteWriter& writer) noexcept : writer_(writer) {}

  void write(const PointState& state) noexcept {
    write(state.p_W);
    write(state.v_W);
  }

  void write(const GripState& grip) noexcept {
    writer_.write(grip.epoch);
    writer_.write(static_cast<std::uint16_t>(grip.object.value_or(kNoObject)));
    writer_.write(toAge(std::round(grip.age * 1e6)));
    write(grip.p_BG);
    write(grip.q_BG.w());
    write(Vec3(grip.q_BG.vec()));
  }

  void write(const ObjectState& object) noexcept {
    writer_.write(static_cast<std::uint16_t>(object.id));
    writer_.write(static_cast<std::uint8_t>(object.epoch.author));
    writer_.write(std::uint8_t{0});
    writer_.write(object.epoch.count);
    const RigidState& state = object.state;
    write(state.p_W);
    write(state.q_WB.w());
    write(Vec3(state.q_WB.vec()));
    write(state.v_W);
    write(state.w_W);
  }

 private:
  void write(double number) noexcept { writer_.write(static_cast<Real>(number)); }

  void write(const Vec3& vector) noexcept {
    write(vector.x());
    write(vector.y());
    write(vector.z());
  }

  wire::ByteWriter& writer_;
};

template <class Real>
class RecordReader {
 public:
  explicit RecordReader(wire::ByteReader& reader) noexcept : reader_(reader) {}

  void read(PointState& state) noexcept {
    read(state.p_W);
    read(state.v_W);
  }

  void read(GripState& grip) noexcept {
    read(grip.p_BG);
    read(grip.q_BG);
  }

  void read(RigidState& state) noexcept {
    read(state.p_W);
    read(state.q_WB);
    read(state.v_W);
    read(state.w_W);
  }

 private:
  void read(double& number) noexcept {
    if constexpr (sizeof(Real) == sizeof(float)) {
      number = static_cast<double>(reader_.readFloat());
    } else {
      number = reader_.readDouble();
    }
  }

  void read(Quat& rotation) noexcept {
    read(rotation.w());
    read(rotation.x());
    read(rotation.y());
    read(rotation.z());
  }

  void read(Vec3& vector) noexcept {
    read(vector.x());
    read(vector.y());
    read(vector.z());
  }

  wire::ByteReader& reader_;
};

template <class Real>
void writeRecords(const StatePacket& packet, wire::ByteWriter& writer) noexcept {
  RecordWriter<Real> records(writer);
  records.write(packet.user);
  if (packet.grip) records.write(*packet.grip);
  if (packet.roll) {
    writer.write(packet.roll->heard.bits());
    writer.write(packet.roll->members.bits());
    writer.write(toAge(roundDown(packet.roll->age * 1e3)));
  }
  for (std::size_t i = 0; i < packet.object_count; ++i) records.write(packet.objects[i]);
}

/// Reads and checks the records one by one; `packet.object_count` is set.
template <class Real>
WireRefusal readRecords(wire::ByteReader& reader, const wire::StateGate& gate,
                        StatePacket& packet) noexcept {
  RecordReader<Real> records(reader);
  wire::ObjectIds seen;
  records.read(packet.user);
  if (const auto fault = gate.check(packet.user); fault != WireRefusal::kNone) return fault;
  if (packet.grip) {
    GripState& grip = *packet.grip;
    grip.epoch = reader.read<std::uint16_t>();
    if (const auto object = reader.read<std::uint16_t>(); object != kNoObject) grip.object = object;
    grip.age = static_cast<double>(reader.read<std::uint32_t>()) / 1e6;
    records.read(grip);
    if (const auto fault = gate.check(grip); fault != WireRefusal::kNone) return fault;
    wire::makeUnit(grip.q_BG);
  }
  if (packet.roll) {
    packet.roll->heard = SiteSet(reader.read<std::uint64_t>());
    packet.roll->members = SiteSet(reader.read<std::uint64_t>());
    packet.roll->age = static_cast<double>(reader.read<std::uint32_t>()) / 1e3;
  }
  for (std::size_t i = 0; i < packet.object_count; ++i) {
    ObjectState& object = packet.objects[i];
    object.id = reader.read<std::uint16_t>();
    object.epoch.author = PeerId{reader.read<std::uint8_t>()};
    const bool zero = reader.read<std::uint8_t>() == 0;
    object.epoch.count = reader.read<std::uint32_t>();
    if (const auto fault = seen.add(object.id); fault != WireRefusal::kNone) return fault;
    if (!zero) return WireRefusal::kZero;
    if (const auto fault = gate.check(object.epoch); fault != WireRefusal::kNone) return fault;
    records.read(object.state);
    if (const auto fault = gate.check(object.state); fault != WireRefusal::kNone) return fault;
    wire::makeUnit(object.state.q_WB);
  }
  return WireRefusal::kNone;
}

WireRefusal readState(ByteView payload, const WireLimits& limits, StateMessage& message) noexcept {
  if (payload.size < kStateBlockSize) return WireRefusal::kTooShort;
  wire::ByteReader reader(payload);
  StatePacket& packet = message.packet;
  message.send_time_us = reader.readTime();
  const std::int64_t state_time_us = reader.readTime();
  packet.sequence = reader.read<std::uint64_t>();
  message.echo_send_time_us = reader.readTime();
  message.echo_hold_us = reader.read<std::uint32_t>();
  message.ack_bits = reader.read<std::uint32_t>();
  message.energy.granted = reader.readDouble();
  message.energy.holdings = reader.readDouble();
  message.flags = reader.read<std::uint16_t>();
  const auto profile = reader.read<std::uint8_t>();
  packet.object_count = reader.read<std::uint8_t>();
  message.config_hash = reader.read<std::uint32_t>();
  packet.time = static_cast<double>(state_time_us) / 1e6;

  if (profile > static_cast<std::uint8_t>(WireProfile::kFloat64)) return WireRefusal::kProfile;
  message.profile = static_cast<WireProfile>(profile);
  if (packet.object_count > packet.objects.size()) return WireRefusal::kObjectCount;
  const bool has_grip = (message.flags & kStateGrip) != 0;
  const bool has_roll = (message.flags & kStateRoll) != 0;
  if (has_grip) packet.grip.emplace();
  if (has_roll) packet.roll.emplace();
  if (payload.size != computeStateSize(message.profile, packet.object_count, has_grip, has_roll))
    return WireRefusal::kWrongSize;
  const wire::StateGate gate(limits);
  if (const auto fault = gate.checkBlock(message, state_time_us); fault != WireRefusal::kNone)
    return fault;
  return message.profile == WireProfile::kFloat32 ? readRecords<float>(reader, gate, packet)
                                                  : readRecords<double>(reader, gate, packet);
}

}  // namespace

std::int64_t toMicroseconds(double seconds) noexcept {
  const double microseconds = seconds * 1e6;
  if (!(microseconds >= 0.0 && microseconds <= static_cast<double>(kMaxWireTimeUs))) return -1;
  return std::llround(microseconds);
}

std::size_t encodeState(const StateMessage& message, ByteSpan out,
                        const WireLimits& limits) noexcept {
  const StatePacket& packet = message.packet;
  const wire::StateGate gate(limits);
  if (gate.check(message) != WireRefusal::kNone || !isSane(packet)) return 0;
  constexpr std::uint16_t kRecords = kStateGrip | kStateRoll;
  if ((message.flags & kRecords) != flagRecords(packet)) return 0;
  if (out.size < computeStateSize(message.profile, packet.object_count, packet.grip.has_value(),
                                  packet.roll.has_value()))
    return 0;

  wire::ByteWriter writer(out);
  writer.write(message.send_time_us);
  writer.write(toMicroseconds(packet.time));
  writer.write(packet.sequence);
  writer.write(message.echo_send_time_us);
  writer.write(message.echo_hold_us);
  writer.write(message.ack_bits);
  writer.write(message.energy.granted);
  writer.write(message.energy.holdings);
  writer.write(message.flags);
  writer.write(static_cast<std::uint8_t>(message.profile));
  writer.write(static_cast<std::uint8_t>(packet.object_count));
  writer.write(message.config_hash);
  if (message.profile == WireProfile::kFloat32) {
    writeRecords<float>(packet, writer);
  } else {
    writeRecords<double>(packet, writer);
  }
  return writer.size();
}

Decoded<StateMessage> decodeState(ByteView payload, PeerId sender,
                                  const WireLimits& limits) noexcept {
  Decoded<StateMessage> message(WireRefusal::kNone);
  message->packet.sender = sender;
  message.refuse(readState(payload, limits, *message));
  return message;
}

}  // namespace tandem
