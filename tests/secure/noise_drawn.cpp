// Draws handshakes and prints all their values as lines of JSON. noise_reference.py recomputes them
// independently.
//
//   tandem_noise_drawn [COUNT [SEED]]

#include <cstdio>
#include <cstdlib>
#include <string>

#include <nlohmann/json.hpp>

#include "coordination/src/wire/wire_sealing.h"
#include "secure/cookie.h"
#include "secure/handshake_tag.h"
#include "secure/seal.h"
#include "secure/secure_support.h"

namespace tandem::test {
namespace {

nlohmann::json drawDatagram(Draw& draw, SecretKey key) {
  const auto sender = static_cast<std::uint16_t>(1 + draw.below(8));
  const auto epoch = static_cast<std::uint16_t>(draw.number());
  const std::uint64_t sequence = draw.below(5);
  const ByteVector header = draw.bytes(draw.below(40)), text = draw.bytes(draw.below(400));
  nlohmann::json drawn{{"sender", sender},
                       {"epoch", epoch},
                       {"sequence", sequence},
                       {"header", toHex(header)},
                       {"text", toHex(text)}};
  drawn["key"] = toHex(key);
  secure::Sealer sealer(std::move(key), computeNonceSalt(PeerId{sender}, epoch));
  ByteVector datagram(text.size() + secure::kTagSize);
  while (sealer.nextSequence() < sequence) (void)sealer.seal(header, datagram);
  std::copy(text.begin(), text.end(), datagram.begin());
  drawn["sealed"] = sealer.seal(header, datagram) ? toHex(datagram) : "refused";
  return drawn;
}

nlohmann::json drawCookie(Draw& draw) {
  const SecretKey secret = draw.key();
  secure::CookieSubject subject{static_cast<std::uint16_t>(draw.number()),
                                static_cast<std::uint16_t>(draw.number()), draw.number()};
  const std::uint64_t slot = draw.below(1000000);
  const secure::CookieMaker maker(copyOf(secret), 1.0);
  return {{"secret", toHex(secret)},
          {"from", subject.from},
          {"to", subject.to},
          {"nonce", subject.nonce},
          {"slot", slot},
          {"cookie", toHex(maker.make(subject, static_cast<double>(slot) + 0.5))}};
}

nlohmann::json drawTag(Draw& draw) {
  const SecretKey key = draw.key();
  const ByteVector covered = draw.bytes(draw.below(100));
  return {{"key", toHex(key)},
          {"covered", toHex(covered)},
          {"tag", toHex(secure::computeTag(key, covered))}};
}

nlohmann::json drawHandshake(Draw& draw) {
  const SecretKey shared = draw.key(), first = draw.key(), second = draw.key();
  const ByteVector prologue = draw.bytes(draw.below(200));
  const ByteVector payloads[] = {draw.bytes(draw.below(200)), draw.bytes(draw.below(200))};
  Pair pair(shared, prologue, copyOf(first), copyOf(second));
  std::array<ByteVector, 2> messages;
  messages[0] = write(pair.initiator, payloads[0]);
  (void)read(pair.responder, messages[0]);
  messages[1] = write(pair.responder, payloads[1]);
  (void)read(pair.initiator, messages[1]);
  nlohmann::json drawn{{"psk", toHex(shared)},
                       {"prologue", toHex(prologue)},
                       {"init_ephemeral", toHex(first)},
                       {"resp_ephemeral", toHex(second)},
                       {"handshake_hash", toHex(pair.initiator.hash())}};
  for (std::size_t i = 0; i < 2; ++i)
    drawn["messages"].push_back(
        {{"payload", toHex(payloads[i])}, {"ciphertext", toHex(messages[i])}});
  auto keys = pair.initiator.split();
  drawn["to_responder"] = toHex(keys->send);
  drawn["to_initiator"] = toHex(keys->receive);
  drawn["datagram"] = drawDatagram(draw, std::move(keys->send));
  drawn["cookie"] = drawCookie(draw);
  drawn["tag"] = drawTag(draw);
  return drawn;
}

}  // namespace
}  // namespace tandem::test

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 20;
  const unsigned long long seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  tandem::test::Draw draw(seed);
  for (int i = 0; i < count; ++i) {
    nlohmann::json drawn = tandem::test::drawHandshake(draw);
    drawn["seed"] = seed;
    std::printf("%s\n", drawn.dump().c_str());
  }
  return 0;
}
