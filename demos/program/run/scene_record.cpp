#include "run/scene_record.h"

#include <iterator>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "files/output_folder.h"

namespace tandem::demos {
namespace {

nlohmann::json describeBody(const PlacedSceneBody& placed) {
  const SceneBody& body = placed.body;
  nlohmann::json j = {{"site", placed.site},
                      {"name", body.name},
                      {"role", body.role},
                      {"shape", body.is_box ? "box" : "sphere"},
                      {"motion", body.is_static ? "static" : "dynamic"}};
  if (body.is_box) {
    j["half_extents"] = {body.half_extents.x(), body.half_extents.y(), body.half_extents.z()};
  } else {
    j["radius"] = body.radius;
  }
  return j;
}

RigidState lookAt(SiteWorld& world, const SceneBody& body) {
  RigidState pose;
  if (body.body) return world.pose(body);
  // The haptic thread moves the hand.
  world.site().betweenTicks([&] { pose = world.pose(body); });
  return pose;
}

}  // namespace

SceneRecord::SceneRecord(const SceneFrame& frame, double duration)
    : frame_(frame), most_(static_cast<std::size_t>(duration * kRate) + 2) {
  frames_.reserve(most_);
}

void SceneRecord::add(int site, SiteWorld& world) {
  worlds_.push_back(&world);
  for (const SceneBody& body : world.bodies()) bodies_.push_back({site, body});
}

bool SceneRecord::isDue(double time) const noexcept {
  if (!frames_.empty() && time <= frames_.back().time) return false;
  return frames_.size() < most_ && time * kRate >= static_cast<double>(frames_.size());
}

void SceneRecord::keep(double time) {
  SceneFrameRecord record;
  record.time = time;
  record.poses.reserve(bodies_.size());
  for (SiteWorld* world : worlds_) {
    for (const SceneBody& body : world->bodies()) {
      RigidState pose = lookAt(*world, body);
      pose.p_W = frame_.toScene(pose.p_W);
      pose.q_WB = body.body ? Quat(frame_.q_WS.conjugate() * pose.q_WB) : pose.q_WB;
      record.poses.push_back(pose);
    }
  }
  frames_.push_back(std::move(record));
}

nlohmann::json SceneRecord::describeBodies() const {
  nlohmann::json list = nlohmann::json::array();
  for (const PlacedSceneBody& body : bodies_) list.push_back(describeBody(body));
  return list;
}

void SceneRecord::writeCsv(const std::filesystem::path& file) const {
  std::string text = "t,site,body,x,y,z,qw,qx,qy,qz\n";
  for (const SceneFrameRecord& frame : frames_) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const RigidState& pose = frame.poses[i];
      fmt::format_to(std::back_inserter(text),
                     "{:.6g},{},{},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g}\n", frame.time,
                     bodies_[i].site, i, pose.p_W.x(), pose.p_W.y(), pose.p_W.z(), pose.q_WB.w(),
                     pose.q_WB.x(), pose.q_WB.y(), pose.q_WB.z());
    }
  }
  writeText(file, text);
}

}  // namespace tandem::demos
