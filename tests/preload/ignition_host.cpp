// A program with Ignition Physics and Debian's unmodified Bullet plugin for it, which does not know
// Tandem. The plugin is opened at run time and exports its Bullet to no other library. Prints a
// line `t x y z` of its box every 50 of 500 steps of 1 ms. With `visitors` another box stands in
// the way of it for 20 of each 40 steps, and the box itself is away from step 300 to 320.
//
//   ignition_host PLUGIN [floor|free|visitors]

#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <ignition/physics/ForwardStep.hh>
#include <ignition/physics/FrameSemantics.hh>
#include <ignition/physics/GetEntities.hh>
#include <ignition/physics/RemoveEntities.hh>
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
                           physics::RemoveModelFromWorld, physics::sdf::ConstructSdfWorld,
                           physics::sdf::ConstructSdfModel, physics::sdf::ConstructSdfLink> {};

constexpr const char* kFloor = R"(
  <model name="floor"><static>true</static><link name="floor"><collision name="floor">
    <geometry><plane><normal>0 0 1</normal></plane></geometry>
  </collision></link></model>)";

/// Text of a box of 0.2 kg; the shared one has 0.1 x 0.1 x 0.05 m.
std::string writeBox(const std::string& pose, const std::string& size) {
  return R"(<sdf version="1.9"><model name="box"><pose>)" + pose + R"( 0 0 0</pose>
  <link name="box">
    <inertial><mass>0.2</mass><inertia>
      <ixx>2.0833e-4</ixx><iyy>2.0833e-4</iyy><izz>3.3333e-4</izz>
    </inertia></inertial>
    <collision name="box"><geometry><box><size>)" +
         size + R"(</size></box></geometry></collision>
  </link></model></sdf>)";
}

bool load(sdf::Root& root, const std::string& text) {
  for (const sdf::Error& error : root.LoadSdfString(text))
    std::fprintf(stderr, "ignition_host: %s\n", error.Message().c_str());
  return root.WorldCount() > 0 || root.Model() != nullptr;
}

using WorldPtr = physics::World3dPtr<Features>;
using ModelPtr = physics::Model3dPtr<Features>;
using LinkPtr = physics::Link3dPtr<Features>;

/// A box of the world. The engine's only way from a model to its links is to make them.
struct Box {
  ModelPtr model;
  LinkPtr link;

  void add(const WorldPtr& world, const char* name, const std::string& text) {
    sdf::Root file;
    if (!load(file, text)) return;
    sdf::Model empty;
    empty.SetName(name);
    empty.SetRawPose(file.Model()->RawPose());
    model = world->ConstructModel(empty);
    link = model->ConstructLink(*file.Model()->LinkByIndex(0));
  }
  void remove() {
    model->Remove();
    model = {};
    link = {};
  }
  Eigen::Vector3d place() const { return link->FrameDataRelativeToWorld().pose.translation(); }
};

constexpr const char* kBoxSize = "0.1 0.1 0.05";

constexpr int kVisitors = 4;

/// Boxes that stand in the way go one by one, and others come. So does the box after step 300. This
/// engine often removes another model than the one that it is asked for; no test relies on which.
class Visitors {
 public:
  explicit Visitors(const WorldPtr& world) : world_(world) {
    for (int i = 0; i < kVisitors; ++i) add(0.082 + 0.1 * i);
  }
  void comeAndGo(int step, Box& box) {
    if (step == 300) box.remove();
    if (step == 320) box.add(world_, "box", writeBox("0 0 0.025", kBoxSize));
    if (step % 40 == 20 && gone_ < kVisitors) visitors_[gone_++].remove();
    if (step % 80 == 0 && box.model) add(box.place().x() + 0.082);
  }

 private:
  void add(double x) {
    const std::string name = "visitor" + std::to_string(visitors_.size());
    visitors_.emplace_back().add(world_, name.c_str(),
                                 writeBox(std::to_string(x) + " 0 0.03", "0.06 0.06 0.06"));
  }

  WorldPtr world_;
  std::vector<Box> visitors_;
  std::size_t gone_ = 0;
};

int run(const char* file, const std::string& scene) {
  ignition::plugin::Loader loader;
  loader.LoadLib(file);
  const auto plugin = loader.Instantiate("ignition::physics::bullet::Plugin");
  const auto engine = physics::RequestEngine3d<Features>::From(plugin);
  if (!engine) return 2;

  const bool has_floor = scene != "free", has_visitors = scene == "visitors";
  sdf::Root world_file, floor_file;
  if (!load(world_file, std::string("<sdf version=\"1.9\"><world name=\"w\"><gravity>0 0 ") +
                            (has_floor ? "-9.81" : "0") + "</gravity>" +
                            (has_floor && !has_visitors ? kFloor : "") + "</world></sdf>") ||
      !load(floor_file, std::string("<sdf version=\"1.9\">") + kFloor + "</sdf>"))
    return 2;
  const WorldPtr world = engine->ConstructWorld(*world_file.WorldByIndex(0));
  std::optional<Visitors> visitors;
  if (has_visitors) visitors.emplace(world);
  Box box;
  box.add(world, "box", writeBox("0 0 0.025", kBoxSize));
  if (has_visitors) world->ConstructModel(*floor_file.Model());
  if (!box.link) return 2;

  physics::ForwardStep::Output output;
  physics::ForwardStep::State state;
  physics::ForwardStep::Input input;
  input.Get<std::chrono::steady_clock::duration>() = std::chrono::milliseconds(1);
  for (int step = 1; step <= 500; ++step) {
    if (visitors) visitors->comeAndGo(step, box);
    world->Step(output, state, input);
    if (step % 50 != 0 || !box.link) continue;
    const Eigen::Vector3d p = box.place();
    std::printf("%.3f %.9g %.9g %.9g\n", 1e-3 * step, p.x(), p.y(), p.z());
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  return run(argv[1], argc < 3 ? "floor" : argv[2]);
}
