#pragma once

#include <optional>

#include "tandem/coordination/wire_handshake.h"
#include "tandem/plugin/outlet.h"

#include "net/session_keys.h"

namespace tandem::net {

/// The responder's half of a handshake, once the cookie was right.
class Answerer {
 public:
  Answerer(const Pair& pair, const SecretKey& key) noexcept : pair_(pair), key_(key) {}

  /// Answers OPEN with ACCEPT, and gives the keys that come into use when something opens under
  /// them. The same OPEN again gets the same answer, and no keys. Nothing is kept of one that does
  /// not open. Takes locked memory.
  [[nodiscard]] std::optional<SessionKeys> onOpen(const OpenMessage& message, const Address& from,
                                                  double now, Outlet& outlet,
                                                  Outcome& outcome) noexcept;

 private:
  [[nodiscard]] std::optional<SessionKeys> answer(const OpenMessage& message, double now,
                                                  Outcome& outcome);

  Pair pair_;
  const SecretKey& key_;
  std::optional<OpenMessage> answered_;
  AcceptMessage accept_;
};

}  // namespace tandem::net
