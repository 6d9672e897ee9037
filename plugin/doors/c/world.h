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

namespace tandem {
class Site;
}

namespace tandem::c_door {

struct WorldBody {
  btRigidBody* rigid = nullptr;
  int place = -1;          ///< in the world's list, when it was looked up last
  bool is_shared = false;  ///< by the site, or its proxy
  std::optional<GuestBody> guest;
  std::uint64_t step = 0;  ///< of guests that it was in last
  std::uint64_t seen = 0;  ///< list of bodies that it was in last
};

class World {
 public:
  static constexpr std::uint32_t kKind = 0x54774f52;
  static constexpr const char* kName = "world";
  static constexpr const char* kUser = "a site";

  World();
  World(btDiscreteDynamicsWorld& host, BulletAbi abi);

  /// Throws TANDEM_WORLD_GONE once the host has destroyed it, as far as a site has noticed.
  [[nodiscard]] btDiscreteDynamicsWorld& bullet() const;
  [[nodiscard]] BulletAbi abi() const noexcept { return abi_; }
  /// Throws std::invalid_argument for a host's world: `what` is for those of Tandem's.
  [[nodiscard]] OwnWorld& own(const char* what) const;

  /// The number of a body that is in the world; a known one keeps it.
  TandemBody number(btRigidBody& rigid);
  /// So that the next number() has room.
  void reserveNumber();
  void forget(TandemBody body) noexcept;
  /// A site shares it no more.
  void release(TandemBody body) noexcept { bodies_[body - 1]->is_shared = false; }

  /// Throws std::invalid_argument for a number never given or given up, tandem::Error for a body
  /// that the host has taken out of its world.
  [[nodiscard]] WorldBody& body(TandemBody body) const;

  /// The site that is on it, which notices its end; null: none.
  void watch(const Site* site) noexcept;

  /// The latest step of guests.
  struct GuestStep {
    std::uint64_t number = 0;
    std::uint64_t lists = 0;  ///< of bodies, looked through so far
    bool is_open = false;
    std::size_t count = 0;
  };
  GuestStep guests;

 private:
  std::unique_ptr<OwnWorld> own_;  ///< null: the host's
  btDiscreteDynamicsWorld* bullet_;
  BulletAbi abi_;
  const Site* site_ = nullptr;
  bool was_gone_ = false;                           ///< when the site before ended
  std::vector<std::unique_ptr<WorldBody>> bodies_;  ///< by number - 1; null: given up
};

}  // namespace tandem::c_door

struct TandemWorld : tandem::c_door::Handle<tandem::c_door::World> {};
