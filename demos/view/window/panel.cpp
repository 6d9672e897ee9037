#include "window/panel.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <imgui.h>

#include "window/panel_parts.h"
#include "window/settings_panel.h"

namespace tandem::view {
namespace {

constexpr HelpLine kHelp[] = {{"move the mouse", "the hand, level"},
                              {"Shift", "the hand, upright"},
                              {"wheel", "the hand, up and down"},
                              {"left button", "hold an object"},
                              {"G", "the hand stays"},
                              {"Page Up, Down", "another world"},
                              {"1, 2, 3", "the scheme"},
                              {"F2 to F6", "who carries contact"},
                              {"Space, full stop", "pause, and one step"},
                              {"right button", "turn the view; wheel: zoom"},
                              {"middle button", "shift the view"},
                              {"F1", "this help"},
                              {"F12", "store a picture"},
                              {"Escape", "end"}};

const char* say(std::uint32_t status) {
  if (status & kStateNotFinite) return "diverged: lower the gains";
  if (status & kOutOfRange) return "flew apart: Reset";
  if (status & kDeviceInvalid) return "no usable device reading";
  if (status & kBodyMissing) return "a shared body is missing";
  return status == kTickOk ? "fine" : "see the status bits";
}

}  // namespace

PanelWishes Panel::show(const SessionControl& control, const SessionLook& look) {
  const demos::Scenario& scenario = control.scenario();
  PanelWishes wishes;
  wishes.session.scenario = scenario;
  wishes.session.pace = control.pace();
  beginPanel(scenario);
  showSettings(control, wishes.session);
  ImGui::Separator();
  showForce(look, scenario.device.max_force > 0.0 ? scenario.device.max_force : 10.0);
  showState(control, look);
  ImGui::Separator();
  showButtons(control, wishes);
  ImGui::End();
  return wishes;
}

void Panel::showButtons(const SessionControl& control, PanelWishes& wishes) {
  ImGui::Checkbox("contacts", &details_.contacts);
  ImGui::SameLine();
  ImGui::Checkbox("joints", &details_.joints);
  ImGui::SameLine();
  ImGui::Checkbox("bounds", &details_.bounds);
  if (control.hasBothSites()) {
    wishes.session.restarts |= ImGui::Button("Reset");
    ImGui::SameLine();
  }
  wishes.takes_picture = askForPicture();
  ImGui::SameLine();
  showHelp(shows_help_, kHelp);
}

void Panel::showForce(const SessionLook& look, double most) {
  const float force = static_cast<float>(look.force_W.norm());
  forces_[static_cast<std::size_t>(next_)] = force;
  next_ = (next_ + 1) % static_cast<int>(forces_.size());
  char text[32];
  std::snprintf(text, sizeof text, "%.2f N", static_cast<double>(force));
  const float scale = static_cast<float>(std::min(most, 10.0));
  ImGui::ProgressBar(force / scale, {-1.0F, 0.0F}, text);
  ImGui::PlotLines("##force", forces_.data(), static_cast<int>(forces_.size()), next_, "force",
                   0.0F, scale, {ImGui::GetContentRegionAvail().x, 60.0F});
}

void Panel::showState(const SessionControl& control, const SessionLook& look) {
  char text[64];
  const char* const pace = control.pace().is_paused ? ", paused" : "";
  std::snprintf(text, sizeof text, "%.3f s%s", look.time, pace);
  describe("time", text);
  if (control.scenario().hasObject()) {
    std::snprintf(text, sizeof text, "%.2f mm", 1e3 * look.apart);
    describe("copies apart", std::isfinite(look.apart) ? text : "one flew apart");
  }
  describe("link",
           look.is_waiting ? "waiting for the other site" : std::string(nameOf(look.link)).c_str());
  describe("state", say(look.status));
  std::snprintf(text, sizeof text, "%.2f J", look.energy);
  describe("energy account", text);
  std::snprintf(text, sizeof text, "%.3f ms, %llu skipped", 1e3 * look.loop.late_p99,
                static_cast<unsigned long long>(look.loop.skipped));
  describe("late, 99 %", look.loop.late_p99 > 0.0 ? text : "no haptic threads");
  for (const std::string& note : control.notes()) ImGui::TextWrapped("%s", note.c_str());
}

}  // namespace tandem::view
