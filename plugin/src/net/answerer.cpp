#include "net/answerer.h"

#include <algorithm>
#include <array>

#include "net/random.h"

namespace tandem::net {

std::optional<SessionKeys> Answerer::onOpen(const OpenMessage& message, const Address& from,
                                            double now, Outlet& outlet, Outcome& outcome) noexcept {
  std::optional<SessionKeys> keys;
  const Seen seen = find(message);
  if (seen == Seen::kEarlier) {
    outcome = Refusal::kReplayed;
    return std::nullopt;
  }
  if (seen == Seen::kNever) {
    try {
      keys = answer(message, now, outcome);
    } catch (const std::exception&) {
      outcome = Refusal::kTooMany;  // no memory to lock: OPEN will come again
    }
    if (!keys) return std::nullopt;
  }
  std::array<std::uint8_t, kAcceptSize> datagram;
  const std::size_t size = encodeAccept(accept_, {datagram.data(), datagram.size()});
  outlet.send({datagram.data(), size}, from);
  outcome = {};
  return keys;
}

Answerer::Seen Answerer::find(const OpenMessage& message) const noexcept {
  if (has_newest_) {
    const Answered& newest = answered_[(answers_ - 1) % kRemembered];
    if (newest.nonce == message.route.nonce && newest.noise == message.noise) return Seen::kLast;
  }
  for (std::size_t i = 0; i < std::min(answers_, kRemembered); ++i)
    if (answered_[i].noise == message.noise) return Seen::kEarlier;
  return Seen::kNever;
}

std::optional<SessionKeys> Answerer::answer(const OpenMessage& message, double now,
                                            Outcome& outcome) {
  secure::Responder noise(key_, writeNoisePrologue(pair_.peer, pair_.self, message.cookie));
  SessionTermsBytes bytes{};
  outcome = Refusal::kKey;
  const auto size = noise.readMessage(message.noise, bytes);
  if (!size || *size != bytes.size()) return std::nullopt;
  const auto terms = readSessionTerms(bytes);
  if (!terms || terms->key_epoch != message.key_epoch) return std::nullopt;
  const auto mine = drawNumber<std::uint32_t>();
  accept_.route = {pair_.self, pair_.peer, message.route.nonce};
  accept_.session = terms->session;
  accept_.key_epoch = terms->key_epoch;
  const SessionTermsBytes answer_terms =
      writeSessionTerms({mine, terms->key_epoch, std::min(terms->minor, kMinorVersion)});
  if (!noise.writeMessage(answer_terms, accept_.noise)) return std::nullopt;
  auto keys = noise.split();
  if (!keys) return std::nullopt;
  answered_[answers_++ % kRemembered] = {message.route.nonce, message.noise};
  has_newest_ = true;
  return SessionKeys(pair_, std::move(*keys), mine, *terms, now);
}

}  // namespace tandem::net
