#include "import/import_world.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "import/import_file.h"
#include "import/imported_world.h"
#include "scenario/body_checks.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

namespace fs = std::filesystem;

std::string endingOf(const fs::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

ImportedWorld read(const fs::path& file, double host_step) {
  if (!isWorldFile(file))
    throw UsageError(file.string() + ": must end in .urdf, .xml (MJCF) or .bullet");
  checkImportFile(file);
  return endingOf(file) == ".bullet" ? importBullet(file, host_step) : importMujoco(file);
}

/// Names that may be shared: each that a body which moves has in the file.
std::vector<std::string> listMoving(const ImportedWorld& world) {
  std::vector<std::string> names;
  for (const auto& [name, body] : world.names)
    if (std::ranges::find(world.bodies, body, &BodyScenario::name)->mass > 0.0)
      names.push_back(name);
  return names;
}

void share(const std::string& name, ImportedWorld& world, const fs::path& file) {
  const auto known = world.names.find(name);
  const auto body = known == world.names.end()
                        ? world.bodies.end()
                        : std::ranges::find(world.bodies, known->second, &BodyScenario::name);
  if (body == world.bodies.end() || body->mass == 0.0)
    throw UsageError(fmt::format("{}: no body \"{}\" that moves can be shared; there are: {}",
                                 file.string(), name, fmt::join(listMoving(world), ", ")));
  body->shared = true;
}

/// Numbers of a file may be any.
void checkNumbers(const ImportedWorld& world, const fs::path& file) {
  const auto is_usable = [](const Vec3& v) { return v.cwiseAbs().maxCoeff() <= 1e6; };
  for (const BodyScenario& body : world.bodies) {
    bool usable = is_usable(body.position) && body.mass >= 0.0 && body.mass <= 1e9 &&
                  (!body.inertia || (is_usable(*body.inertia) && body.inertia->minCoeff() > 0.0));
    for (const PartScenario& part : body.parts) usable &= is_usable(part.position);
    if (!usable)
      throw UsageError(fmt::format("{}: body \"{}\": a number is not finite or beyond 1e6",
                                   file.string(), body.name));
  }
}

}  // namespace

bool isWorldFile(const fs::path& file) {
  const std::string ending = endingOf(file);
  return ending == ".urdf" || ending == ".xml" || ending == ".bullet";
}

void importWorld(Scenario& scenario) {
  if (scenario.world_file.empty()) return;
  const fs::path file = scenario.file.parent_path() / scenario.world_file;
  ImportedWorld world = read(file, 1.0 / scenario.host_rate);
  checkNumbers(world, file);
  for (const std::string& name : scenario.shared) share(name, world, file);
  scenario.bodies.insert(scenario.bodies.end(), world.bodies.begin(), world.bodies.end());
  scenario.joints.insert(scenario.joints.end(), world.joints.begin(), world.joints.end());
  if (std::max(scenario.bodies.size(), scenario.joints.size()) > kMostBodies)
    throw UsageError(
        fmt::format("{}: a world has at most {} bodies and joints", file.string(), kMostBodies));
  scenario.world_file.clear();
  scenario.shared.clear();
  checkBodies(scenario,
              [&](const std::string& text) { throw UsageError(file.string() + ": " + text); });
}

}  // namespace tandem::demos
