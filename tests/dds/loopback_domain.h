#pragma once

#include <cstdlib>
#include <string>

#include <unistd.h>

namespace tandem::test {

/// Restricts Cyclone DDS to loopback and to this process and those that it starts. Gives the domain
/// for it: tests may run several at a time.
inline int openLoopbackDomain() {
  const int process = static_cast<int>(getpid());
  const std::string uri =
      "<General><AllowMulticast>false</AllowMulticast><Interfaces><NetworkInterface name='lo'/>"
      "</Interfaces></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
      "<Peers><Peer address='localhost'/></Peers><Tag>" +
      std::to_string(process) + "</Tag></Discovery>";
  setenv("CYCLONEDDS_URI", uri.c_str(), 1);
  return 1 + process % 200;
}

}  // namespace tandem::test
