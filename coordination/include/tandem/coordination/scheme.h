#pragma once

#include <string_view>
#include <vector>

#pragma GCC visibility push(default)
namespace tandem {

class Island;
struct CouplerGains;
struct PointState;
struct ProxySettings;
struct RemoteUser;

/// A way to let a remote user be present: the interchangeable heart of the comparison.
///
/// A scheme is one file in src/schemes/<name>.cpp that defines `const Scheme& <name>Scheme()`; the
/// build finds it by its name. Schemes hold no state: what they make lives in the island.
class Scheme {
 public:
  virtual ~Scheme() = default;

  /// Name in scenario files.
  [[nodiscard]] virtual std::string_view name() const noexcept = 0;

  /// Set-up: what stands for a remote user whose device is at `start`.
  [[nodiscard]] virtual RemoteUser makeRemoteUser(Island& island, const ProxySettings& proxy,
                                                  const CouplerGains& coordination,
                                                  const PointState& start) const = 0;

  /// In the tick, real-time safe: the user's newest (delayed) state has come in.
  virtual void follow(Island& island, const RemoteUser& user,
                      const PointState& latest) const noexcept = 0;
};

/// All schemes that were built in, ordered by file name.
[[nodiscard]] const std::vector<const Scheme*>& allSchemes();

/// The scheme of that name. Throws std::invalid_argument listing the names there are.
[[nodiscard]] const Scheme& findScheme(std::string_view name);

}  // namespace tandem
#pragma GCC visibility pop
