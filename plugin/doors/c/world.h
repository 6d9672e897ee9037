#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "tandem/bullet_bridge/bullet_abi.h"

#include "bullet_bridge/src/bodies/guest_body.h"
#include "bullet_bridge/src/world/own_world.h"
#include "c/handle.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

// Shown, as where it is defined.
#pragma GCC visibility push(default)
namespace tandem {
class Site;
}
#pragma GCC visibility pop

namespace tandem::c_door {

struct WorldBody {
  btRigidBody* rigid = nullptr;
  int place = -1;          ///< index in the world's list at the last lookup
  bool is_shared = false;  ///< shared by the site, or its proxy
  std::optional<GuestBody> guest;
  std::uint64_t step = 0;  ///< number of its last step as a guest
  std::uint64_t seen = 0;  ///< number of the last list of bodies that named it
};

class World {
 public:
  static constexpr std::uint32_t kKind = 0x54774f52;
  static constexpr const char* kName = "world";
  static constexpr const char* kUser = "a site";

  World();
  World(btDiscreteDynamicsWorld& host, BulletAbi abi);

  /// Throws TANDEM_WORLD_GONE once a site has noticed that the host destroyed the world.
  [[nodiscard]] btDiscreteDynamicsWorld& bullet() const;
  [[nodiscard]] BulletAbi abi() const noexcept { return abi_; }
  /// Throws std::invalid_argument for a host's world. `what` names the refused function.
  [[nodiscard]] OwnWorld& own(const char* what) const;
  [[nodiscard]] bool isOwn() const noexcept { return own_ != nullptr; }

  /// Number of a body in the world; a known body keeps its number.
  TandemBody number(btRigidBody& rigid);
  /// Number of a body that has one, else TANDEM_NO_BODY.
  [[nodiscard]] TandemBody find(const btRigidBody* rigid) const noexcept;
  /// Reserves memory for the next number().
  void reserveNumber();
  void forget(TandemBody body) noexcept;
  /// Ends the sharing of a body.
  void release(TandemBody body) noexcept { bodies_[body - 1]->is_shared = false; }

  /// Throws std::invalid_argument for an unknown or forgotten number. Throws tandem::Error for a
  /// body that the host removed from its world.
  [[nodiscard]] WorldBody& body(TandemBody body) const;

  /// Sets the site that notices the world's end; null: no site.
  void watch(const Site* site) noexcept;

  /// The latest step of guests.
  struct GuestStep {
    std::uint64_t number = 0;
    std::uint64_t lists = 0;  ///< lists of bodies checked so far
    bool is_open = false;
    std::size_t count = 0;
  };
  GuestStep guests;

 private:
  std::unique_ptr<OwnWorld> own_;  ///< null: the host's world
  btDiscreteDynamicsWorld* bullet_;
  BulletAbi abi_;
  const Site* site_ = nullptr;
  bool was_gone_ = false;                           ///< an earlier site noticed the world's end
  std::vector<std::unique_ptr<WorldBody>> bodies_;  ///< by number - 1; null: forgotten
};

}  // namespace tandem::c_door

struct TandemWorld : tandem::c_door::Handle<tandem::c_door::World> {};
