#include "step_log.h"

#include <cerrno>
#include <cstring>

#include "preload/interposer/say.h"

namespace tandem::preload {

StepLog::StepLog(const std::string& file) : file_(std::fopen(file.c_str(), "we")), name_(file) {
  if (!file_ || std::fputs("t,x,y,z,force_x,force_y,force_z,link\n", file_.get()) < 0)
    throw Error(file + ": cannot write this log: " + std::strerror(errno));
}

void StepLog::add(double time, const Vec3& p_W, const Vec3& f_W, std::string_view link) noexcept {
  if (!file_) return;
  const int written =
      std::fprintf(file_.get(), "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.*s\n", time, p_W.x(), p_W.y(),
                   p_W.z(), f_W.x(), f_W.y(), f_W.z(), static_cast<int>(link.size()), link.data());
  if (written > 0) return;
  say("%s: cannot write any more: %s; the log ends here", name_.c_str(), std::strerror(errno));
  file_.reset();
}

}  // namespace tandem::preload
