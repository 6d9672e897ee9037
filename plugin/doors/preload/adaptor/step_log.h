#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "tandem/coordination/types.h"

namespace tandem::preload {

/// A CSV file with a line for each step of the host:
///
///   t,x,y,z,force_x,force_y,force_z,link
///
/// t: the host's time since the object was first shared [s]; where the object is after the step, in
/// W [m]; force on the user's hand in the step's last tick [N]; share of the other site: its link's
/// state, "none" without one.
class StepLog {
 public:
  /// Throws tandem::Error if the file cannot be written.
  explicit StepLog(const std::string& file);

  /// Says so once if the disk is full.
  void add(double time, const Vec3& p_W, const Vec3& f_W, std::string_view link) noexcept;

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::string name_;
};

}  // namespace tandem::preload
