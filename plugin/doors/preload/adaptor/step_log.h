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
/// t is the host's time since the object was first shared [s]. x, y, z is the object's position
/// after the step, in W [m]. The force acts on the user's hand in the step's last tick [N]. link is
/// the state of the link to the other site, or "none".
class StepLog {
 public:
  /// Throws tandem::Error if the file cannot be written.
  explicit StepLog(const std::string& file);

  /// Adds a line. Reports the first failure to write on stderr, and stops the log.
  void add(double time, const Vec3& p_W, const Vec3& f_W, std::string_view link) noexcept;

 private:
  struct Close {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::string name_;
};

}  // namespace tandem::preload
