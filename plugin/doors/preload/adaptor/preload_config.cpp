#include "preload_config.h"

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <vector>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

#include "tandem/plugin/toml_text.h"

namespace tandem::preload {
namespace {

using Setter = std::function<bool(const toml::node&)>;

/// A key, its allowed values and its setter. A setter returns false for any other value.
struct Key {
  std::string name;
  std::string allowed;
  Setter set;
};

std::string show(const toml::node& node) {
  std::ostringstream text;
  node.visit([&](const auto& value) { text << value; });
  std::string line = text.str();
  for (char& c : line)
    if (c == '\n') c = ' ';
  return line.size() > 60 ? line.substr(0, 57) + "..." : line;
}

std::optional<double> readNumber(const toml::node& node, double least, double most) {
  const auto value = node.is_number() ? node.value<double>() : std::nullopt;
  return value && *value >= least && *value <= most ? value : std::nullopt;
}

Setter toNumber(double& target, double least, double most) {
  return [=, &target](const toml::node& node) {
    const auto value = readNumber(node, least, most);
    if (value) target = *value;
    return value.has_value();
  };
}

std::optional<int> readInteger(const toml::node& node, int least, int most) {
  const auto value = node.is_integer() ? node.value<std::int64_t>() : std::nullopt;
  if (!value || *value < least || *value > most) return std::nullopt;
  return static_cast<int>(*value);
}

Setter toInteger(int& target, int least, int most) {
  return [=, &target](const toml::node& node) {
    const auto value = readInteger(node, least, most);
    if (value) target = *value;
    return value.has_value();
  };
}

Setter toPeer(PeerId& target) {
  return [&target](const toml::node& node) {
    const auto value = readInteger(node, 1, static_cast<int>(kMaxPeerId));
    if (value) target = PeerId{static_cast<std::uint32_t>(*value)};
    return value.has_value();
  };
}

Setter toText(std::string& target) {
  return [&target](const toml::node& node) {
    const auto value = node.value<std::string>();
    if (value) target = *value;
    return value && !value->empty();
  };
}

template <typename Target>
Setter toVector(Target& target) {
  return [&target](const toml::node& node) {
    const toml::array* array = node.as_array();
    if (!array || array->size() != 3) return false;
    Vec3 vector;
    for (int i = 0; i < 3; ++i) {
      const auto value = readNumber(*array->get(static_cast<std::size_t>(i)), -1e6, 1e6);
      if (!value) return false;
      vector[i] = *value;
    }
    target = vector;
    return true;
  };
}

Setter toGuide(PreloadConfig& config) {
  return [&config](const toml::node& node) {
    Vec3 along;
    if (!toVector(along)(node) || std::abs(along.norm() - 1.0) > 1e-3) return false;
    config.site.guide = config.device.guide = along.normalized();
    return true;
  };
}

Setter toObject(PreloadConfig& config) {
  return [&config](const toml::node& node) {
    config.index = readInteger(node, 1, 1000000);
    if (const auto text = node.value<std::string>()) config.shape = parseShapeWords(*text);
    return config.index || config.shape;
  };
}

Setter toWidth(std::size_t& bytes) {
  return [&bytes](const toml::node& node) {
    const auto text = node.value<std::string>();
    if (text == "float") bytes = sizeof(float);
    if (text == "float64") bytes = sizeof(double);
    return text == "float" || text == "float64";
  };
}

/// Link settings, collected until all are known.
struct LinkWords {
  PreloadLink link;
  std::string bind, address;
  bool is_there = false;
};

constexpr double kMost = 1e9;

std::string describeRange(const SiteKey& key, const SiteField& field) {
  const std::string unit = std::string(" [") + field.unit + "]";
  if (key.allowed) return key.allowed + unit;
  return (field.range.excludes_least ? "above 0" : "0 or more") + unit;
}

Key toField(const SiteKey& key, SiteSettings& site) {
  const SiteField& field = findSiteField(key.field);
  return {key.name, describeRange(key, field), [&](const toml::node& node) {
            const auto value = readNumber(node, key.least, key.most);
            if (!value || !field.range.contains(*value)) return false;
            field.set(site, *value);
            return true;
          }};
}

std::vector<Key> makeKeys(PreloadConfig& config, double& mass, LinkWords& words) {
  SiteSettings& site = config.site;
  const double tiny = std::numeric_limits<double>::min();
  std::vector<Key> keys = {
      {"process", "the name of a process, on a line of its own before the first table",
       toText(config.process)},
      {"bullet", "\"float\" or \"float64\"", toWidth(config.scalar_bytes)},
      {"world", "a whole number from 1", toInteger(config.world, 1, 1000000)},
      {"object",
       "a whole number from 1, or a shape with or without its sizes [m]: \"box 0.1 0.1 0.2\", "
       "\"sphere 0.05\", \"capsule 0.05 0.1\", \"cylinder 0.05 0.1\", "
       "\"cone 0.05 0.1\", \"hull\"",
       toObject(config)},
      {"mass", "above 0 [kg]", toNumber(mass, tiny, kMost)},
      {"damping", "0 or more [N s/m]", toNumber(config.damping, 0.0, kMost)},
      {"log", "the name of a file", toText(config.log)},
      {"guide", "three numbers of norm 1", toGuide(config)},
      {"site.self", "a whole number from 1 to 64", toPeer(site.self)},
  };
  for (const SiteKey& key : kSiteKeys) keys.push_back(toField(key, site));
  const std::vector<Key> others = {
      {"device.mass", "above 0 [kg]", toNumber(config.device.mass, tiny, kMost)},
      {"device.damping", "0 or more [N s/m]", toNumber(config.device.damping, 0.0, kMost)},
      {"device.max_force", "above 0 [N]", toNumber(config.device.max_force, tiny, kMost)},
      {"device.start", "three numbers [m]", toVector(config.device.start_W)},
      {"device.force", "three numbers [N]", toVector(config.hand_force_W)},
      {"link.peer", "a whole number from 1 to 64", toPeer(words.link.peer)},
      {"link.bind", "an address, \"host:port\" or \":port\"", toText(words.bind)},
      {"link.address", "an address, \"host:port\"", toText(words.address)},
      {"link.key", "the name of a file", toText(words.link.key)},
      {"link.start", "three numbers [m]", toVector(config.remote_start_W)},
      {"link.playout", "true or false",
       [&words](const toml::node& node) {
         words.link.playout = node.value_or(true);
         return node.is_boolean();
       }},
  };
  keys.insert(keys.end(), others.begin(), others.end());
  return keys;
}

class Reader {
 public:
  explicit Reader(const std::string& file) : file_(file), keys_(makeKeys(config_, mass_, link_)) {}

  PreloadConfig read() {
    takeTable(parse(), "");
    checkTogether();
    return std::move(config_);
  }

 private:
  toml::table parse() const {
    try {
      return toml::parse(readTomlText(file_, "config"), file_);
    } catch (const std::invalid_argument& error) {
      throw Error(error.what());
    } catch (const toml::parse_error& error) {
      throw Error(file_ + ":" + std::to_string(error.source().begin.line) +
                  ": not TOML: " + std::string(error.description()));
    }
  }

  void takeTable(const toml::table& table, const std::string& prefix) {
    for (const auto& [name, node] : table) {
      const std::string key = prefix + std::string(name.str());
      link_.is_there |= key == "link";
      if (const toml::table* inner = node.as_table(); inner && hasKeysUnder(key + '.')) {
        takeTable(*inner, key + '.');
      } else {
        take(key, node);
      }
    }
  }

  bool hasKeysUnder(const std::string& prefix) const {
    for (const Key& key : keys_)
      if (key.name.rfind(prefix, 0) == 0) return true;
    return false;
  }

  void take(const std::string& name, const toml::node& node) {
    for (const Key& key : keys_) {
      if (key.name != name) continue;
      if (key.set(node)) return;
      throw Error(file_ + ": " + name + " = " + show(node) + ": must be " + key.allowed);
    }
    std::string all;
    for (const Key& key : keys_) all += (all.empty() ? "" : ", ") + key.name;
    throw Error(file_ + ": " + name + ": there is no such key; allowed: " + all);
  }

  void checkTogether() {
    if (!config_.index && !config_.shape)
      throw Error(file_ + ": object: is missing; it says which body is shared");
    if (mass_ > 0.0) config_.mass = mass_;
    config_.site.hip_radius = config_.site.proxy.radius;
    if (!config_.log.empty()) config_.log = besideConfig(config_.log);
    config_.site.peers = link_.is_there ? 2 : 1;
    if (link_.is_there) takeLink();
    try {
      checkSiteSettings(config_.site);
    } catch (const std::invalid_argument& error) {
      throw Error(file_ + ": " + error.what());
    }
  }

  void takeLink() {
    PreloadLink& link = link_.link;
    if (link_.bind.empty())
      throw Error(file_ + ": link.bind: is missing; it says on which port to hear");
    if (link.key.empty())
      throw Error(file_ + ": link.key: is missing; make one with: tandem key new FILE");
    if (link.peer == config_.site.self)
      throw Error(file_ + ": link.peer: is this site's own number; let site.self be another");
    link.key = besideConfig(link.key);
    resolve("link.bind", link_.bind, [&](const Address& found) { link.bind = found; });
    if (!link_.address.empty())
      resolve("link.address", link_.address, [&](const Address& found) { link.address = found; });
    config_.link = link;
    // A peer that was never heard is not connected yet.
    config_.site.link_loss.start_live = false;
  }

  void resolve(const std::string& key, const std::string& text,
               const std::function<void(const Address&)>& keep) const {
    try {
      keep(resolveAddress(text));
    } catch (const std::invalid_argument& error) {
      throw Error(file_ + ": " + key + ": " + error.what());
    }
  }

  std::string besideConfig(const std::string& path) const {
    return (std::filesystem::path(file_).parent_path() / path).string();
  }

  std::string file_;
  PreloadConfig config_;
  double mass_ = 0.0;
  LinkWords link_;
  std::vector<Key> keys_;
};

}  // namespace

PreloadConfig readPreloadConfig(const std::string& file) { return Reader(file).read(); }

}  // namespace tandem::preload
