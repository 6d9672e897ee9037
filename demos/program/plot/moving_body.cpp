#include "plot/moving_body.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "plot/html.h"
#include "plot/labels.h"

namespace tandem::demos::plot {
namespace {

std::vector<FrameValues> centresOf(const std::vector<Pose>& poses, const Projection& projection) {
  std::vector<FrameValues> centres;
  for (const Pose& pose : poses) {
    const Pixel centre = projection.project(pose.p);
    centres.push_back({centre.x, centre.y});
  }
  return centres;
}

// A user's proxy is told from the user by its dashed outline.
std::string_view dashOf(const SceneBody& body) {
  return body.role == "proxy" ? " stroke-dasharray=\"4 3\"" : "";
}

class BodyDrawing {
 public:
  BodyDrawing(const SceneBody& body, const std::vector<Pose>& poses, const Projection& projection,
              const LoopClock& clock)
      : body_(body), poses_(poses), projection_(projection), clock_(clock) {}

  [[nodiscard]] std::string group(const std::string& id) const {
    const double opacity = body_.role == "proxy" ? 0.65 : body_.is_static ? 0.55 : 1.0;
    const bool turns = body_.is_box && doesRotate(poses_);
    return fmt::format(
        "<g id=\"{}\" stroke=\"#222\" stroke-width=\"0.8\" "
        "opacity=\"{}\"{}><title>{}</title>{}</g>\n",
        id, opacity, dashOf(body_), escapeHtml(body_.name),
        turns ? turningFaces() : shiftedShape());
  }

 private:
  // A body that does not turn is one shape that is shifted.
  [[nodiscard]] std::string shiftedShape() const {
    const std::vector<FrameValues> shifts = centresOf(poses_, projection_);
    return fmt::format("<g transform=\"translate({})\">{}{}</g>", pointsText(shifts.front()),
                       body_.is_box ? stillFaces() : ball(), animateShift(clock_, shifts));
  }

  [[nodiscard]] std::string ball() const {
    const double r = body_.radius * projection_.scale();
    const std::string_view colour = bodyColour(body_);
    return fmt::format(
        "<circle r=\"{:.2f}\" fill=\"{}\"/><circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" "
        "fill=\"#fff\" fill-opacity=\"0.4\" stroke=\"none\"/>",
        r, colour, -0.3 * r, -0.35 * r, 0.32 * r);
  }

  [[nodiscard]] std::string stillFaces() const {
    const Pixel centre = projection_.project(poses_.front().p);
    std::string faces;
    for (int face = 0; face < 6; ++face) {
      if (!isSeen(poses_.front(), face)) continue;
      FrameValues points = corners(poses_.front(), face);
      for (std::size_t i = 0; i < points.size(); i += 2) {
        points[i] -= centre.x;
        points[i + 1] -= centre.y;
      }
      faces += polygon(points, brightness(poses_.front(), face), "");
    }
    return faces;
  }

  // Faces turned away shrink to a point: what is left is never hidden by another face of the box.
  [[nodiscard]] std::string turningFaces() const {
    std::string faces;
    for (int face = 0; face < 6; ++face) {
      std::vector<FrameValues> points;
      std::vector<FrameValues> light;
      for (const Pose& pose : poses_) {
        points.push_back(corners(pose, face));
        light.push_back({brightness(pose, face)});
      }
      if (!collapseUnseen(points, light, face)) continue;
      faces +=
          polygon(points.front(), light.front()[0],
                  animatePoints(clock_, points) + animateFill(clock_, bodyColour(body_), light));
    }
    return faces;
  }

  // False when the face is never seen. Over an unseen stretch, values go in a straight line from
  // its begin to its end, so that it costs two key frames.
  bool collapseUnseen(std::vector<FrameValues>& points, std::vector<FrameValues>& light,
                      int face) const {
    bool is_ever_seen = false;
    for (std::size_t begin = 0; begin < poses_.size();) {
      std::size_t end = begin;
      while (end < poses_.size() && !isSeen(poses_[end], face)) ++end;
      if (end == begin) {
        is_ever_seen = true;
        ++begin;
        continue;
      }
      const FrameValues first = collapsed(points[begin]);
      const FrameValues last = collapsed(points[end - 1]);
      const FrameValues first_light = light[begin];
      const FrameValues last_light = light[end - 1];
      for (std::size_t f = begin; f < end; ++f) {
        const double share = end - begin < 2
                                 ? 0.0
                                 : (clock_.phaseOfFrame(f) - clock_.phaseOfFrame(begin)) /
                                       (clock_.phaseOfFrame(end - 1) - clock_.phaseOfFrame(begin));
        points[f] = between(first, last, share);
        light[f] = between(first_light, last_light, share);
      }
      begin = end;
    }
    return is_ever_seen;
  }

  static FrameValues collapsed(const FrameValues& points) {
    double x = 0;
    double y = 0;
    for (std::size_t i = 0; i < points.size(); i += 2) {
      x += points[i] / 4;
      y += points[i + 1] / 4;
    }
    return {x, y, x, y, x, y, x, y};
  }

  static FrameValues between(const FrameValues& a, const FrameValues& b, double share) {
    FrameValues out(a.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = a[i] + share * (b[i] - a[i]);
    return out;
  }

  // Faces 0 to 5: -x, +x, -y, +y, -z, +z of the body.
  static Vec3 normalOf(const Pose& pose, int face) {
    return pose.q * (Vec3(Vec3::Unit(face / 2)) * (face % 2 == 0 ? -1.0 : 1.0));
  }
  static bool isSeen(const Pose& pose, int face) {
    return normalOf(pose, face).dot(Projection::towardsViewer()) > 0.0;
  }
  static double brightness(const Pose& pose, int face) {
    const Vec3 light = Vec3(-0.35, -0.45, 0.85).normalized();
    return 0.62 + 0.38 * std::max(0.0, normalOf(pose, face).dot(light));
  }

  [[nodiscard]] FrameValues corners(const Pose& pose, int face) const {
    const int along = 1 << (face / 2);
    const int u = 1 << ((face / 2 + 1) % 3);
    const int v = 1 << ((face / 2 + 2) % 3);
    const int base = face % 2 == 0 ? 0 : along;
    FrameValues points;
    for (const int corner : {base, base | u, base | u | v, base | v}) {
      const Pixel at = projection_.project(boxCorner(body_, pose, corner));
      points.push_back(at.x);
      points.push_back(at.y);
    }
    return points;
  }

  [[nodiscard]] std::string polygon(const FrameValues& points, double light,
                                    const std::string& animations) const {
    return fmt::format("<polygon points=\"{}\" fill=\"{}\">{}</polygon>", pointsText(points),
                       shaded(bodyColour(body_), light), animations);
  }

  const SceneBody& body_;
  const std::vector<Pose>& poses_;
  const Projection& projection_;
  const LoopClock& clock_;
};

}  // namespace

std::string drawMovingBody(const SceneBody& body, const std::vector<Pose>& poses,
                           const Projection& projection, const LoopClock& clock,
                           const std::string& id) {
  return BodyDrawing(body, poses, projection, clock).group(id);
}

std::string drawMovingOutline(const SceneBody& body, const std::vector<Pose>& poses,
                              const Projection& projection, const LoopClock& clock) {
  const std::vector<FrameValues> shifts = centresOf(poses, projection);
  return fmt::format(
      "<circle r=\"{:.2f}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.2\"{} "
      "transform=\"translate({})\">{}</circle>\n",
      body.radius * projection.scale(), bodyColour(body), dashOf(body), pointsText(shifts.front()),
      animateShift(clock, shifts));
}

}  // namespace tandem::demos::plot
