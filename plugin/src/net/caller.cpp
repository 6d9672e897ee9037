#include "net/caller.h"

#include <algorithm>
#include <array>

#include "net/random.h"
#include "net/tagged_datagrams.h"

namespace tandem::net {
namespace {

/// A handshake restarts after this time [s]; a cookie is valid for at least 10 s. A round trip may
/// take as long.
constexpr double kOpenFor = 8.5;
constexpr double kMostTook = 5.0;  // upper limit of took() [s]

}  // namespace

void Caller::start(std::uint16_t epoch, double now) noexcept {
  stage_ = Stage::kHello;
  epoch_ = epoch;
  nonce_ = nonces_.next();
  noise_.reset();
  retry_.start(now);
}

void Caller::stop() noexcept {
  stage_ = Stage::kIdle;
  noise_.reset();
}

void Caller::advance(double now, const Paths::Calls& to, Outlet& outlet) noexcept {
  if (stage_ == Stage::kOpen && now - opened_at_ > kOpenFor) start(epoch_, now);
  if (stage_ == Stage::kIdle || !retry_.isDue(now)) return;
  for (const auto& address : to)
    if (address) callAt(*address, outlet);
}

void Caller::callAt(const Address& to, Outlet& outlet) const noexcept {
  if (stage_ == Stage::kIdle) return;
  std::array<std::uint8_t, kHelloSize> datagram;
  const ByteSpan out{datagram.data(), datagram.size()};
  const std::size_t size = stage_ == Stage::kHello
                               ? writeHello({pair_.self, pair_.peer, nonce_}, key_, out)
                               : encodeOpen(open_, out);
  outlet.send({datagram.data(), size}, to);
}

bool Caller::isAnswer(const HandshakeRoute& route) const noexcept {
  return stage_ != Stage::kIdle && route.sender == pair_.peer && route.receiver == pair_.self &&
         route.nonce == nonce_;
}

Outcome Caller::onCookie(ByteView datagram, double now) noexcept {
  const auto message = decodeCookie(datagram);
  if (!message) return message.refusal();
  if (!isAnswer(message->route) || stage_ != Stage::kHello) return Refusal::kOutOfTurn;
  // Only the peer can tag a cookie, so nobody can put another one in place of its own.
  if (!isAuthentic(*message, datagram, key_)) return Refusal::kForged;
  if (!noise_ || open_.cookie != message->cookie) {
    const Outcome outcome = writeOpen(message->cookie);
    if (outcome.refusal != Refusal::kNone) return outcome;
    opened_at_ = now;
  }
  stage_ = Stage::kOpen;
  retry_.start(now);
  return {};
}

Outcome Caller::writeOpen(const CookieBytes& cookie) noexcept {
  try {
    const NoisePrologue prologue = writeNoisePrologue(pair_.self, pair_.peer, cookie);
    session_ = drawNumber<std::uint32_t>();
    const SessionTermsBytes terms = writeSessionTerms({session_, epoch_, kMinorVersion});
    noise_.emplace(key_, prologue);
    open_.route = {pair_.self, pair_.peer, nonce_};
    open_.key_epoch = epoch_;
    open_.cookie = cookie;
    if (!noise_->writeMessage(terms, open_.noise)) return Refusal::kOutOfTurn;
    tagOpen(open_, key_);
  } catch (const std::exception&) {
    noise_.reset();
    return Refusal::kTooMany;  // no memory to lock: HELLO is sent again
  }
  return {};
}

std::optional<SessionKeys> Caller::onAccept(ByteView datagram, double now,
                                            Outcome& outcome) noexcept {
  const auto message = decodeAccept(datagram);
  if (!message) {
    outcome = message.refusal();
    return std::nullopt;
  }
  const bool is_expected = noise_ && isAnswer(message->route) && message->session == session_ &&
                           message->key_epoch == epoch_;
  if (!is_expected) {
    outcome = Refusal::kOutOfTurn;
    return std::nullopt;
  }
  try {
    SessionTermsBytes bytes{};
    outcome = Refusal::kKey;
    const auto size = noise_->readMessage(message->noise, bytes);
    if (!size || *size != bytes.size()) return std::nullopt;
    const auto terms = readSessionTerms(bytes);
    if (!terms || terms->key_epoch != epoch_) return std::nullopt;
    auto keys = noise_->split();
    if (!keys) return std::nullopt;
    outcome = {};
    took_ = std::min(now - opened_at_, kMostTook);
    stop();
    refused_.reset();
    return SessionKeys(pair_, std::move(*keys), session_, *terms, now);
  } catch (const std::exception&) {
    outcome = Refusal::kTooMany;
    return std::nullopt;
  }
}

Outcome Caller::onRefuse(ByteView datagram) noexcept {
  const auto message = decodeRefuse(datagram);
  if (!message) return message.refusal();
  if (!isAnswer(message->route)) return Refusal::kOutOfTurn;
  refused_ = *message;
  // The refusal may be forged, so the same OPEN may still be accepted: only ask for another cookie.
  // Wait for the retry, so that a forger cannot make us flood HELLO.
  if (message->code == RefuseCode::kCookie) stage_ = Stage::kHello;
  return {};
}

}  // namespace tandem::net
