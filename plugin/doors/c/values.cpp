#include "c/values.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include "coordination/src/bad_value.h"

namespace tandem::c_door {
namespace {

/// Tolerance of a unit length, wide enough for a host with float states.
constexpr double kUnit = 1e-6;

[[noreturn]] void refuse(const Name& name, const char* part, const Eigen::VectorXd& values,
                         const char* allowed) {
  std::ostringstream message;
  message << name.whose;
  if (name.place >= 0) message << "[" << name.place << "]";
  message << part << " = ("
          << values.transpose().format(Eigen::IOFormat(6, Eigen::DontAlignCols, ", "))
          << "): must be " << allowed;
  throw std::invalid_argument(message.str());
}

[[nodiscard]] Vec3 readFinite(const Name& name, const char* part, const double* values) {
  const Vec3 v(values[0], values[1], values[2]);
  if (!v.allFinite()) refuse(name, part, v, "finite");
  return v;
}

[[nodiscard]] Quat readUnitQuat(const Name& name, const char* part, const double* values) {
  const Quat q(values[3], values[0], values[1], values[2]);
  if (!(std::abs(q.norm() - 1.0) <= kUnit))
    refuse(name, part, q.coeffs(), "x, y, z, w of length 1");
  return q.normalized();
}

}  // namespace

void refuseNull(const char* name) {
  throw std::invalid_argument(std::string(name) + " is null; give the address of one");
}

void refuseValue(const char* name, double value, const char* allowed) {
  throwBadValue(name, value, allowed);
}

void requireFinite(const char* name, double value) {
  if (!std::isfinite(value)) refuseValue(name, value, "finite");
}
void requirePositive(const char* name, double value) {
  if (!(value > 0.0 && std::isfinite(value))) refuseValue(name, value, "a finite number above 0");
}
void requireNotNegative(const char* name, double value) {
  if (!(value >= 0.0 && std::isfinite(value)))
    refuseValue(name, value, "a finite number, 0 or more");
}

Vec3 readVec3(const char* name, const double* values) {
  return readFinite(name, "", &checkPointer(values, name));
}

Vec3 readVec3OrZero(const char* name, const double* values) {
  return values ? readFinite(name, "", values) : Vec3(Vec3::Zero());
}

Vec3 readUnitVec3(const char* name, const double* values) {
  const Vec3 v = readVec3(name, values);
  if (std::abs(v.norm() - 1.0) > kUnit) refuse(name, "", v, "of length 1");
  return v.normalized();
}

Quat readOrientation(const char* name, const double* values) {
  return readUnitQuat(name, "", &checkPointer(values, name));
}

RigidState fromC(const Name& name, const TandemState& state) {
  RigidState read;
  read.p_W = readFinite(name, ".position", state.position);
  read.v_W = readFinite(name, ".velocity", state.velocity);
  read.w_W = readFinite(name, ".angular_velocity", state.angular_velocity);
  read.q_WB = readUnitQuat(name, ".orientation", state.orientation);
  return read;
}

void writeVec3(const Vec3& v, double* values) noexcept {
  for (int i = 0; i < 3; ++i) values[i] = v[i];
}

void writeLines(const std::vector<std::string>& lines, char* text, std::size_t room,
                std::size_t* length) {
  std::string all;
  for (const std::string& line : lines) all += line + "\n";
  if (room > 0) {
    const std::size_t written = all.copy(&checkPointer(text, "text"), room - 1);
    text[written] = '\0';
  }
  if (length) *length = all.size();
}

TandemState toC(const RigidState& state) noexcept {
  TandemState c;
  writeVec3(state.p_W, c.position);
  for (int i = 0; i < 4; ++i) c.orientation[i] = state.q_WB.coeffs()[i];
  writeVec3(state.v_W, c.velocity);
  writeVec3(state.w_W, c.angular_velocity);
  return c;
}

}  // namespace tandem::c_door
