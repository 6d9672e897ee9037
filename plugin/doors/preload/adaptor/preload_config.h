#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "tandem/falcon/simulated_device.h"
#include "tandem/plugin/address.h"
#include "tandem/plugin/site_settings.h"

#include "object_words.h"

namespace tandem::preload {

/// Address and key of another site.
struct PreloadLink {
  PeerId peer{2};
  Address bind;
  std::optional<Address> address;  ///< empty: the other site calls
  std::string key;                 ///< file name
  bool playout = true;
};

/// Contents of a config file; docs/preload.md lists all keys.
struct PreloadConfig {
  std::string process;           ///< name of the wanted process; empty: any
  std::size_t scalar_bytes = 0;  ///< expected width of btScalar; 0: any
  int world = 1;                 ///< number of the world, in order of creation
  std::optional<int> index;      ///< among the moving bodies, from 1; or else the shape
  std::optional<ShapeWords> shape;
  std::optional<double> mass;  ///< mass that the body must have [kg]
  double damping = 0.0;        ///< of the shared copy [N s/m]
  std::string log;             ///< CSV file; empty: none
  SiteSettings site;
  SimulatedDeviceSettings device;
  Vec3 hand_force_W = Vec3::Zero();  ///< [N]
  std::optional<Vec3> remote_start_W;
  std::optional<PreloadLink> link;
};

/// A key that sets a field of the site.
struct SiteKey {
  const char* name;
  const char* field;              ///< its name in siteFields()
  const char* allowed = nullptr;  ///< null: as the field's range says
  double least = 0.0;
  double most = 1e9;
};

inline constexpr SiteKey kSiteKeys[] = {
    {"site.haptic_rate", "haptic_rate", "10 to 100000", 10.0, 1e5},
    {"site.packet_rate", "packet_rate", "1 to 100000", 1.0, 1e5},
    {"contact.stiffness", "contact.stiffness"},
    {"contact.damping", "contact.damping"},
    {"coordination.stiffness", "coordination.stiffness"},
    {"coordination.damping", "coordination.damping"},
    {"proxy.mass", "proxy.mass"},
    {"proxy.damping", "proxy.damping"},
    {"proxy.radius", "proxy.radius"},
};

/// Reads a TOML file. File names in it are relative to its folder. Throws tandem::Error in one line
/// with file, key, value and what is allowed.
[[nodiscard]] PreloadConfig readPreloadConfig(const std::string& file);

}  // namespace tandem::preload
