#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include <fmt/format.h>

#include "device/device_task.h"
#include "device/get_ready.h"
#include "device/open_device.h"
#include "files/output_lock.h"
#include "terminal/standard_output.h"
#include "terminal/status_line.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

constexpr double kLongest = 3600.0;  // [s]

struct Row {
  double t;
  DeviceSample sample;
  Vec3 force_W;
  int buttons;
};

/// A file being written, by no other program; removed unless it is finished.
class UnfinishedFile {
 public:
  explicit UnfinishedFile(const std::string& target)
      : target_(target),
        path_(target + ".unfinished"),
        lock_(target + ".lock", target),
        file_(path_, std::ios::binary) {
    if (!file_) throw UsageError(target + ": cannot be made; is the folder there and writable?");
  }
  ~UnfinishedFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  void finish(const std::string& text) {
    file_ << text;
    file_.close();
    if (!file_) throw Error("cannot write " + target_ + ": is the disk full?");
    std::filesystem::rename(path_, target_);
  }

 private:
  std::string target_, path_;
  OutputLock lock_;
  std::ofstream file_;
};

std::string makeCsv(const std::vector<Row>& rows) {
  std::string text = "t,valid,x,y,z,vx,vy,vz,force_x,force_y,force_z,buttons\n";
  for (const Row& row : rows) {
    const Vec3 &p = row.sample.hip.p_W, &v = row.sample.hip.v_W, &f = row.force_W;
    fmt::format_to(
        std::back_inserter(text),
        "{:.6f},{:d},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.6g},{:.6g},{:.6g},{}\n", row.t,
        row.sample.valid, p.x(), p.y(), p.z(), v.x(), v.y(), v.z(), f.x(), f.y(), f.z(),
        row.buttons);
  }
  return text;
}

}  // namespace

void recordDevice(const DeviceTask& task, const Pause& pause) {
  UnfinishedFile file(task.file);
  const auto device = openDevice(task.device, placeAlone(), UserWish::kDip);
  const GetReadySettings settings = makeGetReadySettings(task, false);
  if (!getReady(*device, settings, pause)) return;

  StatusLine line(task.quiet);
  if (!task.duration) line.print("recording until Ctrl-C");
  std::vector<Row> rows;
  const Eigen::Matrix3d r_WD = device->map().settings().q_WD.toRotationMatrix();
  // Ctrl-C ends the recording but keeps the file.
  (void)exchange(
      *device, task.duration.value_or(kLongest), pause, [&](double t, const DeviceSample& sample) {
        rows.push_back({t, sample, r_WD * device->guard().force, device->report().buttons});
        if (line.isDue()) line.show(fmt::format("{:8.1f} s recorded", t));
        return Vec3(Vec3::Zero());
      });
  file.finish(makeCsv(rows));
  line.print(fmt::format("{}: {} rows, {:.3f} s", task.file, rows.size(),
                         rows.empty() ? 0.0 : rows.back().t));
  finishOutput();
}

}  // namespace tandem::demos
