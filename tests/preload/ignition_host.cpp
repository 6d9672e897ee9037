// A program with Ignition Physics and Debian's unmodified Bullet plugin for it, which does not know
// Tandem. The plugin is opened at run time and exports its Bullet to no other library. Prints a
// line `t x y z` of its box every 50 of 500 steps of 1 ms.
//
//   ignition_host PLUGIN [floor|free]

#include <chrono>
#include <cstdio>
#include <string>

#include <ignition/physics/ForwardStep.hh>
#include <ignition/physics/FrameSemantics.hh>
#include <ignition/physics/GetEntities.hh>
#include <ignition/physics/RequestEngine.hh>
#include <ignition/physics/sdf/ConstructLink.hh>
#include <ignition/physics/sdf/ConstructModel.hh>
#include <ignition/physics/sdf/ConstructWorld.hh>
#include <ignition/plugin/Loader.hh>
#include <sdf/Link.hh>
#include <sdf/Model.hh>
#include <sdf/Root.hh>
#include <sdf/World.hh>

namespace {

namespace physics = ignition::physics;

struct Features
    : physics::FeatureList<physics::ForwardStep, physics::LinkFrameSemantics,
                           physics::sdf::ConstructSdfWorld, physics::sdf::ConstructSdfModel,
                           physics::sdf::ConstructSdfLink> {};

constexpr const char* kFloor = R"(
  <model name="floor"><static>true</static><link name="floor"><collision name="floor">
    <geometry><plane><normal>0 0 1</normal></plane></geometry>
  </collision></link></model>)";

/// A box of 0.1 x 0.1 x 0.05 m and 0.2 kg.
constexpr const char* kBox = R"(<sdf version="1.9"><model name="box">
  <pose>0 0 0.025 0 0 0</pose>
  <link name="box">
    <inertial><mass>0.2</mass><inertia>
      <ixx>2.0833e-4</ixx><iyy>2.0833e-4</iyy><izz>3.3333e-4</izz>
    </inertia></inertial>
    <collision name="box"><geometry><box><size>0.1 0.1 0.05</size></box></geometry></collision>
  </link></model></sdf>)";

bool load(sdf::Root& root, const std::string& text) {
  for (const sdf::Error& error : root.LoadSdfString(text))
    std::fprintf(stderr, "ignition_host: %s\n", error.Message().c_str());
  return root.WorldCount() > 0 || root.Model() != nullptr;
}

int run(const char* file, bool has_floor) {
  ignition::plugin::Loader loader;
  loader.LoadLib(file);
  const auto plugin = loader.Instantiate("ignition::physics::bullet::Plugin");
  const auto engine = physics::RequestEngine3d<Features>::From(plugin);
  if (!engine) return 2;

  sdf::Root world_file, box_file;
  if (!load(world_file, std::string("<sdf version=\"1.9\"><world name=\"w\"><gravity>0 0 ") +
                            (has_floor ? "-9.81" : "0") + "</gravity>" + (has_floor ? kFloor : "") +
                            "</world></sdf>") ||
      !load(box_file, kBox))
    return 2;
  const auto world = engine->ConstructWorld(*world_file.WorldByIndex(0));
  // The engine's only way from a model to its links is to make them.
  sdf::Model model;
  model.SetName("box");
  model.SetRawPose(box_file.Model()->RawPose());
  const auto box = world->ConstructModel(model)->ConstructLink(*box_file.Model()->LinkByIndex(0));

  physics::ForwardStep::Output output;
  physics::ForwardStep::State state;
  physics::ForwardStep::Input input;
  input.Get<std::chrono::steady_clock::duration>() = std::chrono::milliseconds(1);
  for (int step = 1; step <= 500; ++step) {
    world->Step(output, state, input);
    if (step % 50 != 0) continue;
    const Eigen::Vector3d p = box->FrameDataRelativeToWorld().pose.translation();
    std::printf("%.3f %.9g %.9g %.9g\n", 1e-3 * step, p.x(), p.y(), p.z());
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  return run(argv[1], argc < 3 || std::string(argv[2]) != "free");
}
