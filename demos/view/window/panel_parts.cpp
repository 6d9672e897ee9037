#include "window/panel_parts.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

namespace tandem::view {
namespace {

constexpr float kWidth = 330.0F, kMargin = 10.0F;  // [pixel]

}  // namespace

PictureSize shownSize() {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  return {static_cast<int>(size.x), static_cast<int>(size.y)};
}

void beginPanel(const demos::Scenario& scenario) {
  ImGui::SetNextWindowPos({kMargin, kMargin}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize({kWidth, 0.0F});
  ImGui::Begin("Tandem", nullptr, ImGuiWindowFlags_NoResize);
  ImGui::TextWrapped("%s", scenario.title.c_str());
  if (!scenario.text.empty()) ImGui::TextWrapped("%s", scenario.text.c_str());
  ImGui::Separator();
}

void describe(const char* name, const char* value) {
  ImGui::TextUnformatted(name);
  ImGui::SameLine(140.0F);
  ImGui::TextUnformatted(value);
}

bool askForPicture() {
  return ImGui::Button("Picture") || ImGui::IsKeyPressed(GLFW_KEY_F12, false);
}

void showHelp(bool& is_shown, std::span<const HelpLine> help) {
  if (ImGui::Button("Help") || ImGui::IsKeyPressed(GLFW_KEY_F1, false)) is_shown = !is_shown;
  if (!is_shown) return;
  const float right = ImGui::GetIO().DisplaySize.x - kMargin;
  ImGui::SetNextWindowPos({right, kMargin}, ImGuiCond_Always, {1.0F, 0.0F});
  ImGui::Begin("Help", &is_shown, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse);
  for (const HelpLine& line : help) describe(line.input, line.meaning);
  ImGui::End();
}

}  // namespace tandem::view
