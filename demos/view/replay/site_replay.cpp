#include "replay/site_replay.h"

#include <fmt/format.h>

#include "tandem/bullet_bridge/convert.h"

#include "replay/run_file.h"

namespace tandem::view {
namespace {

btCollisionObject* findObject(btDiscreteDynamicsWorld& world, const btRigidBody* body) {
  btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i)
    if (objects[i] == body) return objects[i];
  return nullptr;
}

}  // namespace

SiteReplay::SiteReplay(const RecordedRun& run, int site)
    : recorded_(*run.sites[static_cast<std::size_t>(site)]),
      frame_(demos::makeSceneFrame(run.scenario)),
      links_(run.scenario),
      world_(run.scenario, site, links_.of(site), device_) {
  findBodies(run, site);
  const double begin = recorded_.scene.times.front();
  hand_start_S_ =
      computePose(recorded_.scene, hand_, begin).p_S - findMoment(recorded_.hand, begin).moved_S;
  moveTo(begin);
}

void SiteReplay::findBodies(const RecordedRun& run, int site) {
  const std::vector<demos::SceneBody>& made = world_.bodies();
  const std::vector<std::string>& names = recorded_.scene.names;
  if (made.size() != names.size())
    refuseRunFile(run.summary, fmt::format("scene.bodies: site {} has {} bodies, the scenario {}",
                                           site + 1, names.size(), made.size()));
  for (std::size_t i = 0; i < made.size(); ++i) {
    if (made[i].name != names[i])
      refuseRunFile(run.summary,
                    fmt::format("scene.bodies: site {} has \"{}\" where the scenario has \"{}\"",
                                site + 1, names[i], made[i].name));
    if (!made[i].body) hand_ = i;
    bodies_.push_back(made[i].body ? findObject(world_.world(), made[i].body) : nullptr);
  }
}

void SiteReplay::moveTo(double time) {
  for (std::size_t body = 0; body < bodies_.size(); ++body) placeBody(body, time);
  const HandMoment& hand = findMoment(recorded_.hand, time);
  hip_W_ = frame_.toWorld(hand_start_S_ + hand.moved_S);
  force_W_ = frame_.toWorld(hand.force_S);
}

void SiteReplay::placeBody(std::size_t body, double time) {
  if (!bodies_[body]) return;
  const RecordedPose pose = computePose(recorded_.scene, body, time);
  const Quat q_WB = frame_.q_WS * pose.q_SB;
  bodies_[body]->setWorldTransform(btTransform(toBullet(q_WB), toBullet(frame_.toWorld(pose.p_S))));
}

}  // namespace tandem::view
