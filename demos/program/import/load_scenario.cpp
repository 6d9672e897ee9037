#include "analyse/safe_gains.h"
#include "import/file_scenario.h"
#include "import/import_world.h"
#include "import/shape_files.h"
#include "scenario/scenario.h"
#include "scenario/toml_input.h"

namespace tandem::demos {

Scenario loadScenario(const std::filesystem::path& file,
                      const std::vector<std::string>& overrides) {
  const bool is_world = isWorldFile(file);
  const std::string text = is_world ? describeFileScenario(file) : readText(file, "scenario");
  Scenario scenario = parseScenario(text, file.string(), overrides);
  scenario.file = file;
  importWorld(scenario);
  readShapeFiles(scenario);
  if (is_world) placeUsers(scenario);
  chooseGains(scenario);
  return scenario;
}

}  // namespace tandem::demos
