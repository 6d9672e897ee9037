#include "bench/program/result_output.h"

#include "demos/program/plot/drawing.h"
#include "demos/program/terminal/standard_output.h"

namespace tandem::demos::bench {

void ResultOutput::open() {
  if (!folder) return;
  files_.emplace(*folder, "--out " + *folder);
  requireDrawing();
}

void ResultOutput::write(const std::string& name, const std::string& json_text,
                         const std::string& table) const {
  if (files_) {
    writeText(*files_ / (name + ".json"), json_text);
    drawBench(*files_ / (name + ".json"));
    files_->publish(name + ".json");
  }
  writeOutput(json ? json_text : table);
}

}  // namespace tandem::demos::bench
