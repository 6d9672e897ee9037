#include "net/state_stream.h"

#include <algorithm>
#include <cmath>

namespace tandem::net {
namespace {

constexpr double kMicro = 1e-6;

double toSeconds(std::int64_t microseconds) noexcept {
  return kMicro * static_cast<double>(microseconds);
}

}  // namespace

std::size_t StateStream::write(const StatePacket& packet, std::uint8_t minor, double now,
                               ByteSpan payload) noexcept {
  StateMessage message;
  message.packet = packet;
  if (minor < kGripMinor) message.packet.grip.reset();
  if (minor < kRollMinor) message.packet.roll.reset();
  message.flags |= flagRecords(message.packet);
  // The time stamp identifies the datagram, so it increases whatever the clock does.
  message.send_time_us = std::max(toMicroseconds(now), last_sent_us_ + 1);
  last_sent_us_ = message.send_time_us;
  if (!unheard_since_) unheard_since_ = now;
  if (has_news_) {
    const double hold = std::max(toSeconds(message.send_time_us) - newest_at_, 0.0);
    message.echo_send_time_us = newest_sent_us_;
    message.echo_hold_us = static_cast<std::uint32_t>(std::min(hold / kMicro, 4294967295.0));
    message.ack_bits = computeAckBits();
  }
  if (packet.is_idle) message.flags |= kStateIdle;
  if (packet.energy) {
    message.flags |= kStateAccount;
    message.energy = *packet.energy;
  }
  message.profile = profile_;
  message.config_hash = config_hash_;
  return encodeState(message, payload);
}

Outcome StateStream::read(ByteView payload, PeerId sender, std::optional<std::uint64_t> sequence,
                          bool is_agreed, double now) noexcept {
  auto message = decodeState(payload, sender);
  if (!message) return message.refusal();
  if (sequence) loss_.noteState(message->packet.sequence, now);
  if (!sequence && has_begun_anew_) return Refusal::kExpired;
  if (sequence && (!has_news_ || *sequence > newest_)) {
    has_news_ = true;
    newest_ = *sequence;
    newest_sent_us_ = message->send_time_us;
    newest_at_ = now;
  }
  if (message->echo_send_time_us > newest_echo_us_) {
    newest_echo_us_ = message->echo_send_time_us;
    unheard_since_.reset();
  }
  if (message->echo_send_time_us != 0)
    trip_.add(toSeconds(message->echo_send_time_us), toSeconds(message->send_time_us),
              kMicro * static_cast<double>(message->echo_hold_us), now);
  if (!is_agreed || message->config_hash != config_hash_) return Refusal::kNotAgreed;
  StatePacket& packet = message->packet;
  if (sequence && is_first_of_keys_) {
    has_begun_anew_ = has_state_ && (packet.sequence + offset_ <= highest_ ||
                                     message->send_time_us < latest_sent_us_);
    if (has_begun_anew_) {
      latest_sent_us_ = 0;
      trip_ = RoundTrip();
      offset_ = highest_ + 1;
      granted_offset_ = granted_;
      playout_.clear();
    }
    is_first_of_keys_ = false;
  }
  latest_sent_us_ = std::max(latest_sent_us_, message->send_time_us);
  packet.sequence += offset_;
  packet.is_idle = (message->flags & kStateIdle) != 0;
  if ((message->flags & kStateAccount) != 0)
    packet.energy = {message->energy.granted + granted_offset_, message->energy.holdings};
  if (!has_state_ || packet.sequence >= highest_) {
    highest_ = packet.sequence;
    if (packet.energy) granted_ = packet.energy->granted;
  }
  has_state_ = true;
  (void)playout_.push(packet, toSeconds(message->send_time_us), now);
  return {};
}

void StateStream::startKeys() noexcept {
  top_.reset();
  came_ = 0;
  has_news_ = false;
  newest_ = 0;
  is_first_of_keys_ = true;
  has_begun_anew_ = false;
  loss_.begin();
  unheard_since_.reset();
}

void StateStream::note(std::uint64_t sequence) noexcept {
  loss_.noteDatagram(sequence);
  if (!top_) top_ = sequence;
  if (sequence > *top_) {
    const std::uint64_t ahead = sequence - *top_;
    came_ = ahead < 64 ? came_ << ahead : 0;
    top_ = sequence;
  }
  const std::uint64_t behind = *top_ - sequence;
  if (behind < 64) came_ |= std::uint64_t{1} << behind;
}

std::uint32_t StateStream::computeAckBits() const noexcept {
  const std::uint64_t behind = *top_ - newest_ + 1;
  return behind < 64 ? static_cast<std::uint32_t>(came_ >> behind) : 0;
}

}  // namespace tandem::net
