#include "island/guide_lines.h"

namespace tandem {

bool canMeet(const IslandModel& model, BodyIndex one, BodyIndex other) {
  const IslandBody& a = model.bodies[static_cast<std::size_t>(one)].settings;
  const IslandBody& b = model.bodies[static_cast<std::size_t>(other)].settings;
  const Vec3& guide = *model.settings.guide;
  const Vec3 way = b.start.p_W - a.start.p_W;
  const Vec3 across = way - guide * guide.dot(way);
  const double apart = across.norm();
  if (apart == 0.0 || std::holds_alternative<Plane>(a.shape) ||
      std::holds_alternative<Plane>(b.shape))
    return true;
  const Vec3 towards = across / apart;
  return apart < computeReach(a.shape, a.start.q_WB.conjugate() * towards) +
                     computeReach(b.shape, b.start.q_WB.conjugate() * -towards);
}

}  // namespace tandem
