#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tandem/plugin/udp_mesh.h"

namespace tandem::test {

/// Free ports of the loopback, as far as one can know.
inline std::vector<std::string> findFreeAddresses(std::size_t count) {
  UdpMeshSettings settings;
  settings.bind = resolveAddress("127.0.0.1:0");
  std::vector<std::unique_ptr<UdpMesh>> meshes;  // each keeps its port until all are found
  std::vector<std::string> addresses;
  for (std::size_t i = 0; i < count; ++i) {
    meshes.push_back(std::make_unique<UdpMesh>(settings, std::vector<UdpPeer>{}));
    addresses.push_back(toString(meshes.back()->bound()));
  }
  return addresses;
}

}  // namespace tandem::test
