#include "plot/animation.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "plot/labels.h"
#include "plot/moving_body.h"
#include "plot/projection.h"
#include "plot/smil.h"

// Layout [px]:
//
//   site 1                          site 2                       t = 1.2 s
//   +---------------------------+   +---------------------------+
//   |  floor grid, then bodies, |   |                           |
//   |  farthest first           |   |                           |
//   +---------------------------+   +---------------------------+
//   |-----o---------------------------------------------| time bar

namespace tandem::demos::plot {
namespace {

constexpr double kWidth = 900;
constexpr double kMargin = 12;
constexpr double kSiteWidth = 430;
constexpr double kTop = 44;
constexpr double kTimeBar = 56;

// A picture's own copy of a run, without what lies outside the picture.
struct Stage {
  Run run;
  SceneMotion motion;
  Bounds bounds;
};

// Cuts the boxes that stand still, such as a wide floor, down to the bounds; what is outside goes.
// Boxes that are not along the axes stay whole.
void cutStillBoxes(Stage& stage) {
  for (std::size_t b = stage.run.bodies.size(); b-- > 0;) {
    SceneBody& body = stage.run.bodies[b];
    Pose& pose = stage.motion.poses[b].front();
    if (!body.is_static || !body.is_box || pose.q.angularDistance(Quat::Identity()) > 1e-6)
      continue;
    Bounds inside = boundsOf(body, pose);
    inside.low = inside.low.cwiseMax(stage.bounds.low);
    inside.high = inside.high.cwiseMin(stage.bounds.high);
    if (inside.size().minCoeff() <= 0.0) {
      stage.run.bodies.erase(stage.run.bodies.begin() + static_cast<std::ptrdiff_t>(b));
      stage.motion.poses.erase(stage.motion.poses.begin() + static_cast<std::ptrdiff_t>(b));
      continue;
    }
    body.half_extents = 0.5 * inside.size();
    pose.p = inside.centre();
    std::fill(stage.motion.poses[b].begin(), stage.motion.poses[b].end(), pose);
  }
}

Stage makeStage(const Run& run, const SceneMotion& motion) {
  Stage stage{run, motion, interestingBounds(run, motion)};
  const double margin = 0.12 * std::max(stage.bounds.size().x(), stage.bounds.size().y());
  stage.bounds.low -= Vec3(margin, margin, 0.1 * margin);
  stage.bounds.high += Vec3(margin, margin, 0.0);
  return stage;
}

std::string floorGrid(const Bounds& bounds, const Projection& projection, double step) {
  std::string path;
  const auto addLine = [&](const Vec3& from, const Vec3& to) {
    const Pixel a = projection.project(from);
    const Pixel b = projection.project(to);
    path += fmt::format("M{:.1f},{:.1f}L{:.1f},{:.1f}", a.x, a.y, b.x, b.y);
  };
  const double z = bounds.low.z();
  for (double x = bounds.low.x(); x <= bounds.high.x() + 0.5 * step; x += step)
    addLine({x, bounds.low.y(), z}, {x, bounds.high.y(), z});
  for (double y = bounds.low.y(); y <= bounds.high.y() + 0.5 * step; y += step)
    addLine({bounds.low.x(), y, z}, {bounds.high.x(), y, z});
  return fmt::format("<path d=\"{}\" stroke=\"#cfd6dc\" stroke-width=\"1\" fill=\"none\"/>\n",
                     path);
}

// Rounds the floor outwards to whole grid cells.
Bounds onGrid(Bounds bounds, double step) {
  for (int axis = 0; axis < 2; ++axis) {
    bounds.low[axis] = std::floor(bounds.low[axis] / step) * step;
    bounds.high[axis] = std::ceil(bounds.high[axis] / step) * step;
  }
  return bounds;
}

// Bodies of one site, each at its place in the drawing order. Where places change during the loop,
// a body stands at every place that it ever takes and is visible at one of them at a time.
std::string siteBodies(const Run& run, const SceneMotion& motion, int site,
                       const Projection& projection, const LoopClock& clock,
                       const std::string& prefix) {
  std::vector<std::size_t> members;
  for (std::size_t b = 0; b < run.bodies.size(); ++b)
    if (run.bodies[b].site == site) members.push_back(b);
  if (members.empty()) return "";

  const DrawingOrders drawing = orderForDrawing(run, motion, members);
  std::vector<double> begins;
  for (const std::size_t frame : drawing.begins) begins.push_back(clock.phaseOfFrame(frame));

  std::string definitions;
  std::string places;
  for (std::size_t place = 0; place < members.size(); ++place)
    for (const std::size_t b : members) {
      std::vector<bool> is_here;
      for (const std::vector<std::size_t>& order : drawing.orders)
        is_here.push_back(order[place] == b);
      if (std::none_of(is_here.begin(), is_here.end(), [](bool here) { return here; })) continue;
      const std::string id = fmt::format("{}-body{}", prefix, b);
      const std::string group =
          drawMovingBody(run.bodies[b], motion.poses[b], projection, clock, id);
      if (std::all_of(is_here.begin(), is_here.end(), [](bool here) { return here; })) {
        places += group;
        continue;
      }
      if (definitions.find("id=\"" + id + "\"") == std::string::npos) definitions += group;
      places += fmt::format("<use href=\"#{}\" visibility=\"{}\">{}</use>\n", id,
                            is_here.front() ? "visible" : "hidden",
                            animateVisibility(clock, begins, is_here));
    }
  for (const std::size_t b : members) {
    const SceneBody& body = run.bodies[b];
    if (!body.is_box && (body.role == "device" || body.role == "proxy"))
      places += drawMovingOutline(body, motion.poses[b], projection, clock);
  }
  return fmt::format("<defs>{}</defs>\n{}", definitions, places);
}

std::string timeLabels(const LoopClock& clock) {
  const double step = std::max(0.1, niceStep(clock.length(), 100));
  const int count = static_cast<int>(clock.length() / step + 1e-9);
  std::string labels;
  for (int i = 0; i <= count; ++i) {
    const double begin = clock.phaseOf(clock.begin() + i * step);
    const double end = std::min(1.0, clock.phaseOf(clock.begin() + (i + 1) * step));
    if (begin >= 1.0) break;
    const std::vector<double> begins =
        i == 0 ? std::vector<double>{0.0, end} : std::vector<double>{0.0, begin, end};
    const std::vector<bool> states =
        i == 0 ? std::vector<bool>{true, false} : std::vector<bool>{false, true, false};
    labels += fmt::format(
        "<text x=\"{}\" y=\"28\" text-anchor=\"end\" visibility=\"{}\">t = {:.1f} s{}</text>\n",
        kWidth - kMargin, i == 0 ? "visible" : "hidden", clock.begin() + i * step,
        animateVisibility(clock, begins, states));
  }
  return labels;
}

std::string timeBar(const LoopClock& clock, double y) {
  const double left = 40;
  const double right = kWidth - 40;
  std::string bar = fmt::format(
      "<path d=\"M{},{:.1f}H{}\" stroke=\"#999\" stroke-width=\"3\" stroke-linecap=\"round\"/>\n",
      left, y, right);
  const double step = niceStep(clock.length(), 8);
  for (double t = 0; t <= clock.length() * 1.02; t += step)
    bar += fmt::format(
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" font-size=\"13\" "
        "fill=\"#555\">{:g} s</text>\n",
        left + (right - left) * t / clock.length(), y + 24, clock.begin() + t);
  return bar + fmt::format(
                   "<circle cx=\"{}\" cy=\"{:.1f}\" r=\"7\" fill=\"#222\"><animate "
                   "attributeName=\"cx\" {} values=\"{};{}\"/></circle>\n",
                   left, y, clock.attributes(), left, right);
}

std::string speedText(const LoopClock& clock) {
  return clock.slowdown() > 1.0 ? fmt::format("slowed down {:.1f} times", clock.slowdown())
                                : "at the speed of the run";
}

}  // namespace

Figure animateScene(const Run& run, const SceneMotion& motion, const std::string& name) {
  const LoopClock clock(motion.times);
  Stage stage = makeStage(run, motion);
  const double step = niceStep(std::max(stage.bounds.size().x(), stage.bounds.size().y()), 10);
  stage.bounds = onGrid(stage.bounds, step);
  cutStillBoxes(stage);

  std::string sites;
  double height = 0;
  for (int site = 1; site <= 2; ++site) {
    const double left = site == 1 ? kMargin : kWidth - kMargin - kSiteWidth;
    const Projection projection(stage.bounds, left, kTop, kSiteWidth);
    height = projection.height();
    sites += fmt::format("<text x=\"{}\" y=\"28\">site {}</text>\n", left, site);
    sites += floorGrid(stage.bounds, projection, step);
    sites += siteBodies(stage.run, stage.motion, site, projection, clock,
                        fmt::format("{}-{}", name, site));
  }

  Figure figure;
  figure.name = name;
  figure.title = fmt::format("The scene at both sites ({})", schemeLabel(run.scheme));
  figure.height = static_cast<int>(kTop + height + kTimeBar);
  figure.svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" role=\"img\" "
      "font-family=\"sans-serif\" font-size=\"17\"><title>{}</title>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{}{}{}</svg>\n",
      figure.width, figure.height, figure.title, sites, timeLabels(clock),
      timeBar(clock, kTop + height + 18));
  figure.caption = fmt::format(
      "Each site’s own copy of the scene, {}; one cell of the floor is {:g} mm. A user’s proxy at "
      "the other site is pale with a dashed outline; users behind a body show as a ring.",
      speedText(clock), step * 1e3);
  return figure;
}

}  // namespace tandem::demos::plot
