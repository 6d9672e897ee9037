#include "window/settings_panel.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <GLFW/glfw3.h>
#include <imgui.h>

#include "tandem/coordination/scheme.h"

#include "scenario/keys.h"
#include "session/own_worlds.h"

namespace tandem::view {
namespace {

struct SpeedChoice {
  const char* name;
  double speed;
};
constexpr std::array<SpeedChoice, 4> kSpeeds = {
    SpeedChoice{"1", 1.0}, {"1/2", 0.5}, {"1/5", 0.2}, {"1/10", 0.1}};

constexpr std::array<ContactModel, 5> kContacts = {
    ContactModel::kIsland, ContactModel::kNativeRigid, ContactModel::kNativeSoft,
    ContactModel::kSpring6Dof, ContactModel::kPointToPoint};

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

/// A list, and a key for each choice from `first_key` on. True if the user chose another one.
template <typename Choices, typename Value, typename NameOf>
bool choose(const char* title, const Choices& choices, int first_key, Value& chosen,
            NameOf name_of) {
  Value wanted = chosen;
  const bool is_open = ImGui::BeginCombo(title, name_of(chosen).c_str());
  for (const Value& choice : choices) {
    if (ImGui::IsKeyPressed(first_key++, false)) wanted = choice;
    if (is_open && ImGui::Selectable(name_of(choice).c_str(), choice == chosen)) wanted = choice;
  }
  if (is_open) ImGui::EndCombo();
  if (wanted == chosen) return false;
  chosen = wanted;
  return true;
}

bool chooseScheme(std::string& chosen) {
  std::vector<std::string> names;
  for (const Scheme* scheme : allSchemes()) names.emplace_back(scheme->name());
  return choose("scheme", names, GLFW_KEY_1, chosen, [](const std::string& name) { return name; });
}

/// A list, and Page Up and Page Down for the neighbours in it.
void chooseWorld(const std::string& now, SessionWishes& wishes) {
  static const std::vector<std::string> worlds = listWorlds();
  const auto at = std::ranges::find(worlds, now);
  if (ImGui::IsKeyPressed(GLFW_KEY_PAGE_UP, false) && at != worlds.begin() && at != worlds.end())
    wishes.world = *(at - 1);
  if (ImGui::IsKeyPressed(GLFW_KEY_PAGE_DOWN, false) && at != worlds.end() &&
      at + 1 != worlds.end())
    wishes.world = *(at + 1);
  if (!ImGui::BeginCombo("world", now.c_str())) return;
  for (const std::string& world : worlds)
    if (ImGui::Selectable(world.c_str(), world == now) && world != now) wishes.world = world;
  ImGui::EndCombo();
}

void showPace(SessionWishes& wishes) {
  Pace& pace = wishes.pace;
  if (ImGui::Button(pace.is_paused ? "Go on" : "Pause") ||
      ImGui::IsKeyPressed(GLFW_KEY_SPACE, false))
    pace.is_paused = !pace.is_paused;
  ImGui::SameLine();
  const bool wants_step = ImGui::Button("Step") || ImGui::IsKeyPressed(GLFW_KEY_PERIOD, true);
  if (wants_step && pace.is_paused) wishes.steps = 1;
  if (wants_step) pace.is_paused = true;
  for (const SpeedChoice& choice : kSpeeds) {
    ImGui::SameLine();
    if (ImGui::RadioButton(choice.name, pace.speed == choice.speed)) pace.speed = choice.speed;
  }
}

void showNetwork(Impairments& network, SessionWishes& wishes) {
  wishes.changes_network |= slideMilliseconds("delay", network.delay, 500.0);
  wishes.changes_network |= slideMilliseconds("jitter", network.jitter, 100.0);
  wishes.changes_network |= slide("loss", network.loss, 0.0, 0.5, "%.2f");
}

void showGains(SiteSettings& site, SessionWishes& wishes) {
  wishes.changes_sites |= slide("K_vc", site.contact.stiffness, 100.0, 8000.0, "%.0f N/m");
  wishes.changes_sites |= slide("B_vc", site.contact.damping, 0.0, 20.0, "%.1f N s/m");
  wishes.changes_sites |= slide("K_t", site.coordination.stiffness, 10.0, 1000.0, "%.0f N/m");
  wishes.changes_sites |= slide("B_t", site.coordination.damping, 0.0, 50.0, "%.1f N s/m");
}

}  // namespace

void showSettings(const SessionControl& control, SessionWishes& wishes) {
  demos::Scenario& scenario = wishes.scenario;
  chooseWorld(scenario.file.stem(), wishes);
  wishes.changes_sites |= chooseScheme(scenario.scheme);
  wishes.changes_sites |= choose("contact", kContacts, GLFW_KEY_F2, scenario.site.contact_model,
                                 [](ContactModel model) { return demos::nameOf(model); });
  if (control.hasBothSites()) showNetwork(scenario.network, wishes);
  showGains(scenario.site, wishes);
  showPace(wishes);
}

}  // namespace tandem::view
