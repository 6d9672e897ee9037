#include "film/frame_sink.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <sys/wait.h>

#include "tandem/coordination/types.h"

#include "terminal/usage_error.h"

namespace tandem::view {
namespace {

/// Frames of a folder that the user may draw from in any program.
class PictureFolder final : public FrameSink {
 public:
  explicit PictureFolder(const std::filesystem::path& folder) : folder_(folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw Error(fmt::format("--out {}: {}", folder.string(), error.message()));
  }
  void add(const Picture& picture) override {
    const auto file = folder_ / fmt::format("frame_{:05}.png", count_++);
    if (const auto problem = writePng(picture, file)) throw Error(*problem);
  }
  void finish() override {}

 private:
  std::filesystem::path folder_;
  int count_ = 0;
};

/// Settings of ffmpeg for each kind of film, compared for size and look.
const std::map<std::string, std::string> kEncoders = {
    {".mp4", "-c:v libx264 -crf 26 -pix_fmt yuv420p -movflags +faststart"},
    {".webm", "-c:v libvpx-vp9 -crf 36 -b:v 0 -pix_fmt yuv420p"},
    {".gif",
     "-vf \"fps=10,scale=480:-1:flags=lanczos,split[a][b];[a]palettegen=max_colors=64[p];"
     "[b][p]paletteuse=dither=none:diff_mode=rectangle\""}};

/// The name in single quotes for a shell, whatever it contains.
std::string quote(const std::string& name) {
  std::string quoted = "'";
  for (const char c : name) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

/// Frames through a pipe into ffmpeg. The film has its name only once it is whole.
class VideoFile final : public FrameSink {
 public:
  VideoFile(std::filesystem::path out, PictureSize size, double rate)
      : out_(std::move(out)), part_(out_.parent_path() / (".part_" + out_.filename().string())) {
    if (std::system("command -v ffmpeg >/dev/null 2>&1") != 0)
      throw Error(fmt::format(
          "--out {}: there is no ffmpeg; install it (apt-get install ffmpeg), or name a folder "
          "without an ending to get PNG frames",
          out_.string()));
    std::signal(SIGPIPE, SIG_IGN);  // a film that cannot be written is an error, not the end
    const std::string command = fmt::format(
        "ffmpeg -y -loglevel error -f rawvideo -pixel_format rgba -video_size {}x{} -framerate {} "
        "-i - {} {}",
        size.width, size.height, rate, kEncoders.at(out_.extension()), quote(part_.string()));
    pipe_ = popen(command.c_str(), "w");
    if (!pipe_)
      throw Error(fmt::format("--out {}: ffmpeg: {}", out_.string(), std::strerror(errno)));
  }
  ~VideoFile() override {
    if (pipe_) pclose(pipe_);
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
  }
  void add(const Picture& picture) override {
    if (std::fwrite(picture.rgba.data(), 1, picture.rgba.size(), pipe_) != picture.rgba.size())
      throw Error(fmt::format("--out {}: ffmpeg ended early; is the disk full?", out_.string()));
  }
  void finish() override {
    const int status = pclose(std::exchange(pipe_, nullptr));
    if (status != 0)
      throw Error(
          fmt::format("--out {}: ffmpeg ended with status {}", out_.string(), WEXITSTATUS(status)));
    std::filesystem::rename(part_, out_);
  }

 private:
  std::filesystem::path out_, part_;
  std::FILE* pipe_ = nullptr;
};

}  // namespace

std::unique_ptr<FrameSink> makeFrameSink(const std::filesystem::path& out, PictureSize size,
                                         double rate) {
  if (out.extension().empty()) return std::make_unique<PictureFolder>(out);
  if (kEncoders.count(out.extension())) return std::make_unique<VideoFile>(out, size, rate);
  throw demos::UsageError(fmt::format(
      "--out {}: must end in .mp4, .webm or .gif, or be a folder without an ending", out.string()));
}

}  // namespace tandem::view
