#include "import/mujoco/mujoco_model.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

/// Files in memory that MuJoCo finds before those of the disk. It is large.
class MemoryFile {
 public:
  MemoryFile(const std::string& name, const std::string& text) {
    mj_defaultVFS(files_.get());
    if (mj_makeEmptyFileVFS(files_.get(), name.c_str(), static_cast<int>(text.size())) != 0)
      throw UsageError("MuJoCo takes no file of this name; rename it");
    std::memcpy(files_->filedata[0], text.data(), text.size());
  }
  ~MemoryFile() { mj_deleteVFS(files_.get()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] const mjVFS* get() const { return files_.get(); }

 private:
  std::unique_ptr<mjVFS> files_ = std::make_unique<mjVFS>();
};

/// URDF with settings for MuJoCo, unless it has its own: links keep their names.
std::string setUp(std::string urdf, bool with_visuals) {
  const std::size_t robot = urdf.find("<robot");
  const std::size_t end = robot == std::string::npos ? robot : urdf.find('>', robot);
  if (end == std::string::npos || urdf.find("<mujoco") != std::string::npos) return urdf;
  const std::string discard = with_visuals ? "false" : "true";
  return urdf.insert(end + 1, R"(<mujoco><compiler fusestatic="false" discardvisual=")" + discard +
                                  "\"/></mujoco>");
}

using Model = std::unique_ptr<mjModel, FreeMujoco>;

Model compile(const std::filesystem::path& file, const std::string& text, std::string& error) {
  const MemoryFile memory(file.filename().string(), text);
  std::array<char, 1000> line{};
  Model model(mj_loadXML(file.c_str(), memory.get(), line.data(), static_cast<int>(line.size())));
  error = line.data();
  return model;
}

void ignoreWarning(const char*) {}

/// MuJoCo expects that this does not return.
void refuse(const char* text) { throw UsageError(std::string("MuJoCo: ") + text); }

}  // namespace

MujocoModel loadMujoco(const std::filesystem::path& file, const std::string& text) {
  // MuJoCo's own handlers write a file, and end the program.
  mju_user_warning = &ignoreWarning;
  mju_user_error = &refuse;
  if (text.empty()) throw UsageError("is empty; export it again");
  std::string error;
  // Visual parts give colours, but often are in formats that MuJoCo does not know.
  Model model = compile(file, setUp(text, true), error);
  if (!model) model = compile(file, setUp(text, false), error);
  if (!model) {
    while (!error.empty() && error.back() == '\n') error.pop_back();
    std::ranges::replace(error, '\n', ' ');
    throw UsageError("not URDF or MJCF that MuJoCo reads: " + error);
  }
  std::unique_ptr<mjData, FreeMujoco> start(mj_makeData(model.get()));
  mj_kinematics(model.get(), start.get());
  return {std::move(model), std::move(start)};
}

}  // namespace tandem::demos
