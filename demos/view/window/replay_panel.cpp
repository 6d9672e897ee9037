#include "window/replay_panel.h"

#include <algorithm>
#include <cstdio>

#include <GLFW/glfw3.h>
#include <imgui.h>

#include "window/panel_parts.h"

namespace tandem::view {
namespace {

constexpr HelpLine kReplayHelp[] = {{"space", "play or pause"},
                                    {"left, right", "one picture back, on"},
                                    {"Home, End", "the beginning, the end"},
                                    {"up, down", "faster, slower"},
                                    {"right button", "turn the view; wheel: zoom"},
                                    {"middle button", "shift the view"},
                                    {"F1", "this help"},
                                    {"F12", "store a picture"},
                                    {"Escape", "end"}};

constexpr double kSlowest = 0.05, kFastest = 4.0;  // recorded seconds for each second
constexpr double kSpeedStep = 2.0;

/// Keys that move the clock; a step repeats while its key is down.
void obeyKeys(ReplayClock& clock) {
  if (ImGui::IsKeyPressed(GLFW_KEY_SPACE, false)) clock.toggle();
  if (ImGui::IsKeyPressed(GLFW_KEY_LEFT)) clock.step(-1);
  if (ImGui::IsKeyPressed(GLFW_KEY_RIGHT)) clock.step(1);
  if (ImGui::IsKeyPressed(GLFW_KEY_HOME, false)) clock.seek(0.0);
  if (ImGui::IsKeyPressed(GLFW_KEY_END, false)) clock.seek(clock.duration());
  if (ImGui::IsKeyPressed(GLFW_KEY_UP, false)) clock.speed *= kSpeedStep;
  if (ImGui::IsKeyPressed(GLFW_KEY_DOWN, false)) clock.speed /= kSpeedStep;
  clock.speed = std::clamp(clock.speed, kSlowest, kFastest);
}

}  // namespace

bool ReplayPanel::show(const demos::Scenario& scenario, const SessionLook& look,
                       ReplayClock& clock) {
  if (!ImGui::GetIO().WantTextInput) obeyKeys(clock);
  beginPanel(scenario);
  showClock(clock);
  ImGui::Separator();
  showNumbers(scenario, look);
  ImGui::Separator();
  const bool takes_picture = askForPicture();
  ImGui::SameLine();
  showHelp(shows_help_, kReplayHelp);
  ImGui::End();
  return takes_picture;
}

void ReplayPanel::showClock(ReplayClock& clock) {
  double time = clock.time();
  const double least = 0.0, most = clock.duration();
  ImGui::SetNextItemWidth(-1.0F);
  if (ImGui::SliderScalar("##time", ImGuiDataType_Double, &time, &least, &most, "%.3f s",
                          ImGuiSliderFlags_AlwaysClamp))
    clock.seek(time);
  if (ImGui::Button(clock.isPlaying() ? "Pause" : "Play", {70.0F, 0.0F})) clock.toggle();
  ImGui::SameLine();
  if (ImGui::Button("<")) clock.step(-1);
  ImGui::SameLine();
  if (ImGui::Button(">")) clock.step(1);
  ImGui::SameLine();
  ImGui::SetNextItemWidth(100.0F);
  ImGui::SliderScalar("speed", ImGuiDataType_Double, &clock.speed, &kSlowest, &kFastest, "x %.2f",
                      ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
}

void ReplayPanel::showNumbers(const demos::Scenario& scenario, const SessionLook& look) {
  char text[64];
  describe("scheme", scenario.scheme.c_str());
  std::snprintf(text, sizeof text, "%.0f ms", 1e3 * scenario.network.delay);
  describe("delay", text);
  std::snprintf(text, sizeof text, "%.2f N", look.force_W.norm());
  describe("force", text);
  if (!scenario.hasObject()) return;
  std::snprintf(text, sizeof text, "%.2f mm", 1e3 * look.apart);
  describe("copies apart", text);
}

}  // namespace tandem::view
