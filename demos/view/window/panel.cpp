#include "window/panel.h"

#include <algorithm>
#include <cstdio>

#include <GLFW/glfw3.h>
#include <imgui.h>

#include "tandem/coordination/scheme.h"

namespace tandem::view {
namespace {

constexpr float kWidth = 330.0F;  // [pixel]

constexpr const char* kHelp =
    "move the mouse      the hand, level\n"
    "Shift               the hand, upright\n"
    "wheel               the hand, up and down\n"
    "left button         hold an object\n"
    "G                   the hand stays\n"
    "1, 2, 3             the scheme\n"
    "right button        turn the view; wheel: zoom\n"
    "middle button       shift the view\n"
    "F1                  this help\n"
    "F12                 store a picture\n"
    "Escape              end";

void describe(const char* name, const char* value) {
  ImGui::TextUnformatted(name);
  ImGui::SameLine(140.0F);
  ImGui::TextUnformatted(value);
}

/// A slider for a double whose change takes effect when the user lets go of it.
bool slide(const char* name, double& value, double least, double most, const char* format) {
  ImGui::SliderScalar(name, ImGuiDataType_Double, &value, &least, &most, format,
                      ImGuiSliderFlags_AlwaysClamp);
  return ImGui::IsItemDeactivatedAfterEdit();
}

bool slideMilliseconds(const char* name, double& seconds, double most_ms) {
  double ms = 1e3 * seconds;
  const bool is_set = slide(name, ms, 0.0, most_ms, "%.0f ms");
  seconds = 1e-3 * ms;
  return is_set;
}

/// A list, and a digit for each scheme. True if the user chose another one.
bool chooseScheme(std::string& chosen) {
  std::string wanted = chosen;
  const bool is_open = ImGui::BeginCombo("scheme", chosen.c_str());
  int key = GLFW_KEY_1;
  for (const Scheme* scheme : allSchemes()) {
    const std::string name(scheme->name());
    if (ImGui::IsKeyPressed(key++, false)) wanted = name;
    if (is_open && ImGui::Selectable(name.c_str(), name == chosen)) wanted = name;
  }
  if (is_open) ImGui::EndCombo();
  if (wanted == chosen) return false;
  chosen = wanted;
  return true;
}

const char* say(std::uint32_t status) {
  if (status & kStateNotFinite) return "diverged: lower the gains";
  if (status & kDeviceInvalid) return "no usable device reading";
  if (status & kBodyMissing) return "a shared body is missing";
  return status == kTickOk ? "fine" : "see the status bits";
}

}  // namespace

PanelWishes Panel::show(demos::Scenario& scenario, const SessionLook& look,
                        const std::vector<std::string>& notes, bool may_change) {
  PanelWishes wishes;
  ImGui::SetNextWindowPos({10.0F, 10.0F}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize({kWidth, 0.0F});
  ImGui::Begin("Tandem", nullptr, ImGuiWindowFlags_NoResize);
  ImGui::TextWrapped("%s", scenario.title.c_str());
  if (!scenario.text.empty()) ImGui::TextWrapped("%s", scenario.text.c_str());
  ImGui::Separator();
  if (may_change)
    showSettings(scenario, wishes);
  else
    describe("scheme", scenario.scheme.c_str());
  ImGui::Separator();
  showForce(look, scenario.device_max_force > 0.0 ? scenario.device_max_force : 10.0);
  showState(scenario, look, notes);
  ImGui::Separator();
  ImGui::Checkbox("contacts", &details_.contacts);
  ImGui::SameLine();
  ImGui::Checkbox("joints", &details_.joints);
  ImGui::SameLine();
  ImGui::Checkbox("bounds", &details_.bounds);
  if (may_change) {
    wishes.restarts |= ImGui::Button("Reset");
    ImGui::SameLine();
  }
  wishes.takes_picture = ImGui::Button("Picture") || ImGui::IsKeyPressed(GLFW_KEY_F12, false);
  ImGui::SameLine();
  if (ImGui::Button("Help") || ImGui::IsKeyPressed(GLFW_KEY_F1, false)) shows_help_ = !shows_help_;
  if (shows_help_) ImGui::TextUnformatted(kHelp);
  ImGui::End();
  return wishes;
}

void Panel::showSettings(demos::Scenario& scenario, PanelWishes& wishes) {
  wishes.changes_scheme |= chooseScheme(scenario.scheme);
  Impairments& network = scenario.network;
  wishes.changes_network |= slideMilliseconds("delay", network.delay, 500.0);
  wishes.changes_network |= slideMilliseconds("jitter", network.jitter, 100.0);
  wishes.changes_network |= slide("loss", network.loss, 0.0, 0.5, "%.2f");
  SiteSettings& site = scenario.site;
  wishes.changes_scheme |= slide("K_vc", site.contact.stiffness, 100.0, 8000.0, "%.0f N/m");
  wishes.changes_scheme |= slide("B_vc", site.contact.damping, 0.0, 20.0, "%.1f N s/m");
  wishes.changes_scheme |= slide("K_t", site.coordination.stiffness, 10.0, 1000.0, "%.0f N/m");
  wishes.changes_scheme |= slide("B_t", site.coordination.damping, 0.0, 50.0, "%.1f N s/m");
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

void Panel::showState(const demos::Scenario& scenario, const SessionLook& look,
                      const std::vector<std::string>& notes) {
  char text[64];
  std::snprintf(text, sizeof text, "%.1f s", look.time);
  describe("time", text);
  if (scenario.hasObject()) {
    std::snprintf(text, sizeof text, "%.2f mm", 1e3 * look.apart);
    describe("copies apart", text);
  }
  describe("link",
           look.is_waiting ? "waiting for the other site" : std::string(nameOf(look.link)).c_str());
  describe("state", say(look.status));
  std::snprintf(text, sizeof text, "%.2f J", look.energy);
  describe("energy account", text);
  std::snprintf(text, sizeof text, "%.3f ms, %llu skipped", 1e3 * look.loop.late_p99,
                static_cast<unsigned long long>(look.loop.skipped));
  describe("late, 99 %", text);
  for (const std::string& note : notes) ImGui::TextWrapped("%s", note.c_str());
}

}  // namespace tandem::view
