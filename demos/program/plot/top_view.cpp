#include "plot/top_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "plot/labels.h"

namespace tandem::demos::plot {
namespace {

constexpr double kPanelWidth = 240;  // [px]
constexpr double kLeft = 82;
constexpr double kColumnGap = 41;
constexpr double kFirstTop = 98;
constexpr double kRowGap = 36;
constexpr double kPi = 3.14159265358979323846;

using Point = Eigen::Vector2d;

// What a panel shows: a piece of the x-y plane.
struct View {
  Range x;
  Range y;
};

// The views at the three moments, all of one size so that shapes compare. When the bodies travel
// far along an axis, each view goes with the bodies of its moment; otherwise all views are the
// same.
struct Camera {
  std::array<std::size_t, 3> frames;
  std::array<View, 3> views;
  bool moves_in_y = false;  // then every panel needs its own tic labels
  double panel_height = 0;  // [px]
};

Camera makeCamera(const Run& run, const SceneMotion& motion) {
  constexpr double kMargin = 1.12;
  constexpr double kFar = 4.0;  // travel against the size of the group of bodies
  Camera camera;
  camera.frames = {0, motion.frames() / 2, motion.frames() - 1};
  const Bounds all = movingBounds(run, motion, 0, motion.frames());
  std::array<Bounds, 3> moments;
  Vec3 size = Vec3::Zero();
  for (std::size_t m = 0; m < 3; ++m) {
    moments[m] = movingBounds(run, motion, camera.frames[m], camera.frames[m] + 1);
    size = size.cwiseMax(moments[m].size());
  }
  const bool moves_in_x = all.size().x() > kFar * size.x();
  camera.moves_in_y = all.size().y() > kFar * size.y();
  const Bounds shown = interestingBounds(run, motion);
  if (!moves_in_x) size.x() = shown.size().x();
  if (!camera.moves_in_y) size.y() = shown.size().y();

  const double scale = kPanelWidth / (kMargin * std::max(size.x(), size.y() * 0.5));  // [px/m]
  camera.panel_height = std::clamp(scale * kMargin * size.y(), 100.0, 2.2 * kPanelWidth);
  const Vec3 half = 0.5 * Vec3(kPanelWidth, camera.panel_height, 0.0) / scale;
  for (std::size_t m = 0; m < 3; ++m) {
    const double x = moves_in_x ? moments[m].centre().x() : shown.centre().x();
    const double y = camera.moves_in_y ? moments[m].centre().y() : shown.centre().y();
    camera.views[m] = {{1e3 * (x - half.x()), 1e3 * (x + half.x())},
                       {1e3 * (y - half.y()), 1e3 * (y + half.y())}};
  }
  return camera;
}

// Corners of the convex hull, counter-clockwise (monotone chain).
std::vector<Point> hullOf(std::vector<Point> points) {
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  const auto turnsLeft = [](const Point& a, const Point& b, const Point& c) {
    const Point u = b - a;
    const Point v = c - b;
    return u.x() * v.y() - u.y() * v.x() > 0.0;
  };
  std::vector<Point> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t begin = hull.size();
    for (const Point& point : points) {
      while (hull.size() >= begin + 2 && !turnsLeft(hull[hull.size() - 2], hull.back(), point))
        hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

std::string outlineRows(const SceneBody& body, const Pose& pose) {
  std::vector<Point> outline;
  if (body.is_box) {
    for (int corner = 0; corner < 8; ++corner)
      outline.push_back(boxCorner(body, pose, corner).head<2>());
    outline = hullOf(std::move(outline));
  } else {
    for (int i = 0; i < 40; ++i)
      outline.push_back(pose.p.head<2>() +
                        body.radius * Point(std::cos(kPi * i / 20), std::sin(kPi * i / 20)));
  }
  outline.push_back(outline.front());
  std::string rows;
  for (const Point& p : outline) rows += fmt::format("{:.5g} {:.5g}\n", 1e3 * p.x(), 1e3 * p.y());
  return rows;
}

std::string pathRows(const std::vector<Pose>& poses, std::size_t end) {
  std::string rows;
  for (std::size_t f = 0; f <= end; ++f)
    rows += fmt::format("{:.5g} {:.5g}\n", 1e3 * poses[f].p.x(), 1e3 * poses[f].p.y());
  return rows;
}

bool isUser(const SceneBody& body) { return body.role == "device" || body.role == "proxy"; }

// What lies below what: obstacles that stand still, other bodies by the height of their tops,
// users.
std::vector<std::size_t> bodiesFromBelow(const Run& run, const SceneMotion& motion, int site,
                                         std::size_t frame) {
  const auto layer = [&](std::size_t b) {
    return isUser(run.bodies[b]) ? 2 : run.bodies[b].is_static ? 0 : 1;
  };
  const auto top = [&](std::size_t b) {
    return boundsOf(run.bodies[b], motion.poses[b][frame]).high.z();
  };
  std::vector<std::size_t> order;
  for (std::size_t b = 0; b < run.bodies.size(); ++b)
    if (run.bodies[b].site == site) order.push_back(b);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(layer(a), top(a)) < std::pair(layer(b), top(b));
  });
  return order;
}

void drawBodies(FigureWriter& writer, const Run& run, const SceneMotion& motion, int site,
                std::size_t frame) {
  const std::vector<std::size_t> order = bodiesFromBelow(run, motion, site, frame);
  std::vector<std::string> plots;
  const auto addBody = [&](std::size_t b) {
    const SceneBody& body = run.bodies[b];
    const std::string outline = writer.addData(outlineRows(body, motion.poses[b][frame]));
    const bool is_proxy = body.role == "proxy";
    plots.push_back(
        fmt::format("{} with filledcurves closed fs transparent solid {} noborder lc rgb '{}'",
                    outline, is_proxy || body.is_static ? 0.45 : 0.9, bodyColour(body)));
    plots.push_back(fmt::format("{} with lines lw 1 dt {} lc rgb '#333333'", outline,
                                is_proxy ? "(4,3)" : "1"));
  };
  const auto addPath = [&](std::size_t b) {
    plots.push_back(fmt::format(
        "{} with lines lw 1.8 dt {} lc rgb '{}'", writer.addData(pathRows(motion.poses[b], frame)),
        run.bodies[b].role == "proxy" ? "(5,4)" : "1", bodyColour(run.bodies[b])));
  };
  for (const std::size_t b : order)
    if (run.bodies[b].is_static) addBody(b);
  for (const std::size_t b : order)
    if (isUser(run.bodies[b]) && frame > 0) addPath(b);
  for (const std::size_t b : order)
    if (!run.bodies[b].is_static) addBody(b);
  if (!plots.empty()) writer.plot(plots);
}

std::vector<LegendEntry> legendOf(const Run& run) {
  std::vector<LegendEntry> legend = {
      {{fmt::format("points pt 7 ps 1.6 lc rgb '{}'", kUser1Colour)}, "user 1"},
      {{fmt::format("points pt 7 ps 1.6 lc rgb '{}'", kUser2Colour)}, "user 2"}};
  for (const char* role : {"object", "neighbour", "obstacle"}) {
    const auto found = std::find_if(run.bodies.begin(), run.bodies.end(),
                                    [&](const SceneBody& body) { return body.role == role; });
    if (found != run.bodies.end())
      legend.push_back({{fmt::format("points pt 5 ps 1.6 lc rgb '{}'", bodyColour(*found))}, role});
  }
  return legend;
}

}  // namespace

Figure topView(const Run& run, const SceneMotion& motion, const std::string& name) {
  const Camera camera = makeCamera(run, motion);
  const double height = kFirstTop + 2 * camera.panel_height + kRowGap + 58;
  FigureWriter writer(name,
                      fmt::format("The scene from above, to scale ({})", schemeLabel(run.scheme)),
                      static_cast<int>(height));
  writer.legend({82, 40, 802, 26}, legendOf(run));
  for (int site = 1; site <= 2; ++site)
    for (std::size_t m = 0; m < 3; ++m) {
      const std::size_t frame = camera.frames[m];
      writer.beginPanel({kLeft + static_cast<double>(m) * (kPanelWidth + kColumnGap),
                         kFirstTop + (site - 1) * (camera.panel_height + kRowGap), kPanelWidth,
                         camera.panel_height},
                        fmt::format("site {}, {:.2f} s", site, motion.times[frame]));
      writer.command("set border 15");
      writer.setRange('x', camera.views[m].x);
      writer.setRange('y', camera.views[m].y);
      writer.setTics('x', camera.views[m].x, kPanelWidth, 46);
      writer.setTics('y', camera.views[m].y, camera.panel_height, 20);
      if (site == 1) writer.hideTicLabels('x');
      if (site == 2) writer.setLabel('x', "x [mm]");
      if (m == 0) writer.setLabel('y', "y [mm]");
      if (m > 0 && !camera.moves_in_y) writer.hideTicLabels('y');
      drawBodies(writer, run, motion, site, frame);
    }
  return std::move(writer).finish(
      "Each site’s own copy of the scene at the start, the middle and the end. A user’s proxy at "
      "the other site is pale with a dashed outline; lines show the ways of user (solid) and proxy "
      "(dashed) so far.");
}

}  // namespace tandem::demos::plot
