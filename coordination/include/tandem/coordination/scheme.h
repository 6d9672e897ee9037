#pragma once

#include <string_view>
#include <vector>

#pragma GCC visibility push(default)
namespace tandem {

class Island;
struct PointState;
struct RemoteUser;
struct StandInSettings;

/// A coordination scheme: how a remote user is represented. Schemes are what Tandem compares.
///
/// A scheme is one file src/schemes/<name>.cpp that defines `const Scheme& <name>Scheme()`; the
/// build finds it by its name. Schemes hold no state: the bodies they make live in the island.
class Scheme {
 public:
  virtual ~Scheme() = default;

  /// The scheme's name in scenario files.
  [[nodiscard]] virtual std::string_view name() const noexcept = 0;

  /// Set-up: makes the representation of a remote user whose device is at `start`.
  [[nodiscard]] virtual RemoteUser makeRemoteUser(Island& island, const StandInSettings& stand_in,
                                                  const PointState& start) const = 0;

  /// Applies the user's newest (delayed) state. Called in the tick; real-time safe.
  virtual void follow(Island& island, const RemoteUser& user,
                      const PointState& latest) const noexcept = 0;
};

/// All built-in schemes, ordered by file name.
[[nodiscard]] const std::vector<const Scheme*>& allSchemes();

/// The scheme of that name. Throws std::invalid_argument listing all names.
[[nodiscard]] const Scheme& findScheme(std::string_view name);

}  // namespace tandem
#pragma GCC visibility pop
