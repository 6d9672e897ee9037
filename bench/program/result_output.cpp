#include "bench/program/result_output.h"

#include <filesystem>

#include "demos/program/files/output_folder.h"
#include "demos/program/plot/drawing.h"
#include "demos/program/terminal/standard_output.h"

namespace tandem::demos::bench {

void ResultOutput::check() const {
  if (!folder) return;
  prepareFolder(*folder);
  requireDrawing();
}

void ResultOutput::write(const std::string& name, const std::string& json_text,
                         const std::string& table) const {
  if (folder) {
    const std::filesystem::path file = std::filesystem::path(*folder) / (name + ".json");
    writeText(file, json_text);
    drawBench(file);
  }
  writeOutput(json ? json_text : table);
}

}  // namespace tandem::demos::bench
