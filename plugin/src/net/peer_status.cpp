// The status of a pair's session as its host sees it, and the words for it.

#include "net/peer_session.h"
#include "net/relayed_address.h"

namespace tandem::net {
namespace {

constexpr double kGone = 5.0;  ///< a silent peer counts as gone after this [s]

}  // namespace

PeerStatus PeerSession::status(double now) const {
  PeerStatus status;
  status.peer = pair_.peer;
  if (left_)
    status.phase = PeerPhase::kLeft;
  else if (!keys_ || now - heard_at_ > kGone)
    status.phase = PeerPhase::kCalling;
  else if (agreement_.isEqual())
    status.phase = PeerPhase::kLive;
  else
    status.phase = agreement_.difference() ? PeerPhase::kDifferent : PeerPhase::kAgreeing;
  status.address = paths_.inUse();
  status.is_relayed = status.address && relayedPeer(*status.address);
  status.address_changes = paths_.moves();
  status.silence = keys_ ? now - heard_at_ : 0.0;
  status.round_trip = stream_.trip().trip();
  status.clock_offset = stream_.trip().offset();
  const Playout& playout = stream_.playout();
  status.wait = playout.wait();
  status.jitter = playout.jitter();
  status.loss = stream_.loss();
  status.key_epoch = keys_ ? keys_->epoch() : std::uint16_t{0};
  status.states_sent = states_sent_;
  status.states_unsent = states_unsent_;
  status.states_given = playout.counts().given;
  status.states_stale = playout.counts().stale;
  status.states_too_late = playout.counts().too_late;
  if (const auto& refused = caller_.refused(); refused && !keys_) {
    status.refused = refused->code;
    status.refused_version = refused->version;
  }
  status.is_called_with_another_key = is_called_with_another_key_ && !keys_;
  status.left = left_;
  if (keys_ || left_ == ByeReason::kConfigurationsDiffer)
    status.difference = agreement_.difference();
  return status;
}

}  // namespace tandem::net

namespace tandem {

const char* name(PeerPhase phase) noexcept {
  switch (phase) {
    case PeerPhase::kCalling:
      return "calling";
    case PeerPhase::kAgreeing:
      return "agreeing";
    case PeerPhase::kDifferent:
      return "different";
    case PeerPhase::kLive:
      return "live";
    case PeerPhase::kLeft:
      return "left";
  }
  return "";
}

const char* explain(RefuseCode code) noexcept {
  switch (code) {
    case RefuseCode::kVersion:
      return "it speaks another version; install the same release on both sides";
    case RefuseCode::kUnknownPeer:
      return "it does not expect this site; compare the ids on both sides";
    case RefuseCode::kCookie:
      return "our datagrams reach it too late";
    case RefuseCode::kKey:
      return "it has another key; give both sides the same key file";
    case RefuseCode::kBusy:
      return "it is busy";
  }
  return "it says no reason";
}

}  // namespace tandem
