#include "scene/world_lines.h"

#include <utility>

#include <LinearMath/btIDebugDraw.h>

#include "tandem/bullet_bridge/convert.h"

namespace tandem::view {
namespace {

constexpr double kFarthest = 1000.0;            // of a line's ends from the origin, per axis [m]
constexpr auto kNormalLength = btScalar(0.01);  // of the line that shows a contact's normal [m]

Colour toColour(const btVector3& c) {
  return {static_cast<float>(c.x()), static_cast<float>(c.y()), static_cast<float>(c.z())};
}

/// False also for what is not finite.
bool isNear(const Vec3& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() <= kFarthest; }

int debugMode(const WorldDetails& details) {
  int mode = btIDebugDraw::DBG_NoDebug;
  if (details.joints) {
    mode |= btIDebugDraw::DBG_DrawConstraints | btIDebugDraw::DBG_DrawConstraintLimits;
  }
  if (details.contacts) mode |= btIDebugDraw::DBG_DrawContactPoints;
  if (details.bounds) mode |= btIDebugDraw::DBG_DrawAabb;
  return mode;
}

/// A debug drawer that keeps the lines instead of drawing them.
class LineCollector : public btIDebugDraw {
 public:
  explicit LineCollector(int mode) : mode_(mode) {}

  using btIDebugDraw::drawLine;
  void drawLine(const btVector3& from, const btVector3& to, const btVector3& colour) override {
    const Line line = {fromBullet(from), fromBullet(to), toColour(colour), 1.0F};
    if (isNear(line.from_W) && isNear(line.to_W)) lines_.push_back(line);
  }
  void drawContactPoint(const btVector3& point, const btVector3& normal, btScalar /*distance*/,
                        int /*life_time*/, const btVector3& colour) override {
    drawLine(point, point + normal * kNormalLength, colour);
  }
  void reportErrorWarning(const char* /*warning*/) override {}
  void draw3dText(const btVector3& /*location*/, const char* /*text*/) override {}
  void setDebugMode(int mode) override { mode_ = mode; }
  [[nodiscard]] int getDebugMode() const override { return mode_; }

  [[nodiscard]] std::vector<Line> takeLines() { return std::move(lines_); }

 private:
  int mode_;
  std::vector<Line> lines_;
};

/// Gives the world another debug drawer until the end of the scope.
class DrawerLoan {
 public:
  DrawerLoan(btDiscreteDynamicsWorld& world, btIDebugDraw& drawer)
      : world_(world), own_(world.getDebugDrawer()) {
    world.setDebugDrawer(&drawer);
  }
  ~DrawerLoan() { world_.setDebugDrawer(own_); }
  DrawerLoan(const DrawerLoan&) = delete;
  DrawerLoan& operator=(const DrawerLoan&) = delete;

 private:
  btDiscreteDynamicsWorld& world_;
  btIDebugDraw* own_;
};

}  // namespace

std::vector<Line> collectWorldLines(btDiscreteDynamicsWorld& world, const WorldDetails& details) {
  if (!details.any()) return {};
  LineCollector collector(debugMode(details));
  const DrawerLoan loan(world, collector);
  world.debugDrawWorld();
  return collector.takeLines();
}

}  // namespace tandem::view
