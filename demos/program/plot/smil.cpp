#include "plot/smil.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>

#include <fmt/format.h>

namespace tandem::demos::plot {
namespace {

constexpr double kShortest = 5.0;    // a loop lasts at least this long [s]
constexpr double kTolerance = 0.2;   // of a coordinate [px]
constexpr double kShadeStep = 0.01;  // of a brightness

bool isStraight(const LoopClock& clock, const std::vector<FrameValues>& values, std::size_t begin,
                std::size_t end, double tolerance) {
  const double t0 = clock.phaseOfFrame(begin);
  const double t1 = clock.phaseOfFrame(end);
  for (std::size_t f = begin + 1; f < end; ++f) {
    const double share = (clock.phaseOfFrame(f) - t0) / (t1 - t0);
    for (std::size_t i = 0; i < values[f].size(); ++i) {
      const double straight = values[begin][i] + share * (values[end][i] - values[begin][i]);
      if (std::abs(values[f][i] - straight) > tolerance) return false;
    }
  }
  return true;
}

std::string animation(const LoopClock& clock, std::string_view head,
                      const std::vector<FrameValues>& values, double tolerance,
                      const std::function<std::string(const FrameValues&)>& text) {
  if (isStill(values, tolerance)) return "";
  std::string key_times;
  std::string list;
  for (const std::size_t frame : keyFrames(clock, values, tolerance)) {
    const char* separator = frame == 0 ? "" : ";";
    key_times += fmt::format("{}{:.4g}", separator, clock.phaseOfFrame(frame));
    list += separator + text(values[frame]);
  }
  return fmt::format("<{} {} keyTimes=\"{}\" values=\"{}\"/>", head, clock.attributes(), key_times,
                     list);
}

}  // namespace

LoopClock::LoopClock(const std::vector<double>& times)
    : times_(times), begin_(times.front()), end_(times.back()) {
  if (!(end_ > begin_)) end_ = begin_ + 1.0;  // a single frame: a still picture
  slowdown_ = std::max(1.0, kShortest / length());
}

std::string LoopClock::attributes() const {
  return fmt::format("dur=\"{:.3f}s\" repeatCount=\"indefinite\"", length() * slowdown_);
}

std::vector<std::size_t> keyFrames(const LoopClock& clock, const std::vector<FrameValues>& values,
                                   double tolerance) {
  constexpr std::size_t kLongest = 90;  // frames between two keys: bounds the search
  const std::size_t last = values.size() - 1;
  std::vector<std::size_t> keys = {0};
  while (keys.back() < last) {
    const std::size_t begin = keys.back();
    std::size_t end = begin + 1;
    while (end < std::min(last, begin + kLongest) &&
           isStraight(clock, values, begin, end + 1, tolerance))
      ++end;
    keys.push_back(end);
  }
  return keys;
}

bool isStill(const std::vector<FrameValues>& values, double tolerance) {
  for (const FrameValues& frame : values)
    for (std::size_t i = 0; i < frame.size(); ++i)
      if (std::abs(frame[i] - values.front()[i]) > tolerance) return false;
  return true;
}

std::string animatePoints(const LoopClock& clock, const std::vector<FrameValues>& points) {
  return animation(clock, "animate attributeName=\"points\"", points, kTolerance, pointsText);
}

std::string animateShift(const LoopClock& clock, const std::vector<FrameValues>& shifts) {
  return animation(clock, "animateTransform attributeName=\"transform\" type=\"translate\"", shifts,
                   kTolerance, pointsText);
}

std::string animateFill(const LoopClock& clock, std::string_view colour,
                        const std::vector<FrameValues>& brightness) {
  return animation(clock, "animate attributeName=\"fill\"", brightness, kShadeStep,
                   [&](const FrameValues& value) { return shaded(colour, value[0]); });
}

std::string animateVisibility(const LoopClock& clock, const std::vector<double>& begins,
                              const std::vector<bool>& states) {
  std::string key_times;
  std::string values;
  for (std::size_t k = 0; k < begins.size(); ++k) {
    if (k > 0 && states[k] == states[k - 1]) continue;
    key_times += fmt::format("{}{:.4g}", k == 0 ? "" : ";", begins[k]);
    values += fmt::format("{}{}", k == 0 ? "" : ";", states[k] ? "visible" : "hidden");
  }
  return fmt::format(
      "<animate attributeName=\"visibility\" calcMode=\"discrete\" {} keyTimes=\"{}\" "
      "values=\"{}\"/>",
      clock.attributes(), key_times, values);
}

std::string pointsText(const FrameValues& points) {
  std::string text;
  for (std::size_t i = 0; i + 1 < points.size(); i += 2)
    text += fmt::format("{}{:.1f},{:.1f}", i == 0 ? "" : " ", points[i], points[i + 1]);
  return text;
}

std::string shaded(std::string_view colour, double brightness) {
  std::string text = "#";
  for (std::size_t i = 1; i < 7; i += 2) {
    int channel = 0;
    std::from_chars(colour.data() + i, colour.data() + i + 2, channel, 16);
    text += fmt::format("{:02x}", std::clamp(static_cast<int>(channel * brightness), 0, 255));
  }
  return text;
}

}  // namespace tandem::demos::plot
