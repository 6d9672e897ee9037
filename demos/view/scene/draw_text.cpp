#include "scene/draw_text.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

namespace tandem::view {
namespace {

/// Rounds to 1e-6. Adding zero turns a negative zero into zero.
double rounded(double value) { return std::round(value * 1e6) / 1e6 + 0.0; }

std::string text(const Vec3& v) {
  return fmt::format("{:.6f} {:.6f} {:.6f}", rounded(v.x()), rounded(v.y()), rounded(v.z()));
}

/// A rotation has two quaternions, q and -q. Rounding comes first, so that a tiny part does not
/// choose between them.
std::string text(const Quat& q) {
  Eigen::Vector4d parts(rounded(q.w()), rounded(q.x()), rounded(q.y()), rounded(q.z()));
  const auto first = std::find_if(parts.begin(), parts.end(), [](double p) { return p != 0; });
  if (first != parts.end() && *first < 0) parts = -parts;
  return fmt::format("{:.6f} {:.6f} {:.6f} {:.6f}", parts[0] + 0.0, parts[1] + 0.0, parts[2] + 0.0,
                     parts[3] + 0.0);
}

int toByte(float part) {
  return static_cast<int>(std::lround(std::clamp(part, 0.0F, 1.0F) * 255.0F));
}

std::string text(const Colour& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", toByte(colour.red), toByte(colour.green),
                     toByte(colour.blue));
}

/// A name on one line.
std::string text(std::string name) {
  std::replace(name.begin(), name.end(), '\n', ' ');
  return name;
}

std::size_t countTriangles(const Solid& solid) {
  return solid.mesh ? solid.mesh->indices.size() / 3 : 0;
}

}  // namespace

std::string writeDrawList(const DrawList& list) {
  std::string out;
  for (const Solid& solid : list.solids) {
    fmt::format_to(std::back_inserter(out), "{}: {} triangles at {} turned {} colour {}{}\n",
                   text(solid.name), countTriangles(solid), text(solid.p_WB), text(solid.q_WB),
                   text(solid.colour), solid.is_ghost ? " ghost" : "");
  }
  for (const Line& line : list.lines) {
    fmt::format_to(std::back_inserter(out), "line from {} to {} colour {} width {:.1f}\n",
                   text(line.from_W), text(line.to_W), text(line.colour), line.width);
  }
  return out;
}

}  // namespace tandem::view
