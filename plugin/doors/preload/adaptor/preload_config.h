#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/address.h"
#include "tandem/plugin/site_settings.h"

#include "object_words.h"

namespace tandem::preload {

/// How another site is reached.
struct PreloadLink {
  PeerId peer{2};
  Address bind;
  std::optional<Address> address;  ///< nothing: it calls
  std::string key;                 ///< file
  bool playout = true;
};

/// What a config file says; docs/preload.md has all keys.
struct PreloadConfig {
  std::string process;           ///< name of the process that is meant; empty: any
  std::size_t scalar_bytes = 0;  ///< width of btScalar that is expected; 0: any
  int world = 1;                 ///< counted as they are made
  std::optional<int> index;      ///< of the moving bodies, counted from 1; or
  std::optional<ShapeWords> shape;
  std::optional<double> mass;  ///< that the body must have [kg]
  double damping = 0.0;        ///< of the shared copy [N s/m]
  std::string log;             ///< CSV file; empty: none
  SiteSettings site;
  SimulatedDeviceSettings device;
  Vec3 hand_force_W = Vec3::Zero();  ///< [N]
  std::optional<Vec3> remote_start_W;
  std::optional<PreloadLink> link;
};

/// Reads a TOML file; files that it names are found from its folder. Throws tandem::Error, in one
/// line with file, key, value and what is allowed.
[[nodiscard]] PreloadConfig readPreloadConfig(const std::string& file);

}  // namespace tandem::preload
