#pragma once

#include <memory>
#include <set>
#include <utility>

#include "stub_engine.h"

namespace tandem::test {

/// Contacts of a stub engine, which Bullet solves with the solver's settings of PyBullet's server.
/// Bodies have all pieces of their shapes: boxes, spheres, capsules, cylinders and planes.
class StubContacts {
 public:
  StubContacts();
  ~StubContacts();
  StubContacts(const StubContacts&) = delete;
  StubContacts& operator=(const StubContacts&) = delete;

  /// Moves all bodies for one internal step, after their forces.
  void move(std::map<int, StubBody>& bodies, const std::set<std::pair<int, int>>& without_contact,
            double dt);

 private:
  struct World;
  std::unique_ptr<World> world_;
};

/// Principal moments that PyBullet gives a body: those of its shape, of the whole mass [kg m^2].
Vec3 computeStubInertia(const StubBody& body);

}  // namespace tandem::test
