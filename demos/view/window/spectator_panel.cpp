#include "window/spectator_panel.h"

#include <cstdio>
#include <string>

#include <GLFW/glfw3.h>
#include <imgui.h>

#include "window/panel_parts.h"

namespace tandem::view {
namespace {

constexpr HelpLine kHelp[] = {{"1 to 9", "the copies of this user"},
                              {"Tab", "those of the next one"},
                              {"Home", "all users in the picture"},
                              {"right button", "turn the view; wheel: zoom"},
                              {"middle button", "shift the view"},
                              {"F1", "this help"},
                              {"F12", "store a picture"},
                              {"Escape", "end"}};

constexpr float kLabelAway = 9.0F;  // from the hand's middle [pixel]

bool canFollow(const UserLook& user) { return !user.has_another_scenario; }

std::optional<int> findNext(const SessionLook& look) {
  std::optional<int> first;
  for (const UserLook& one : look.users) {
    if (!canFollow(one)) continue;
    if (look.followed && one.user > *look.followed) return one.user;
    if (!first) first = one.user;
  }
  return first;
}

std::optional<int> readKeys(const SessionLook& look) {
  if (ImGui::IsKeyPressed(GLFW_KEY_TAB, false)) return findNext(look);
  for (const UserLook& one : look.users)
    if (one.user < 9 && canFollow(one) && ImGui::IsKeyPressed(GLFW_KEY_1 + one.user, false))
      return one.user;
  return std::nullopt;
}

std::string describeUser(const UserLook& one) {
  char text[64];
  const char* const state = one.is_live ? "live" : "silent";
  std::snprintf(text, sizeof text, "user %d   %s, %.2f s ago", one.user + 1, state, one.age);
  if (one.has_another_scenario)
    std::snprintf(text, sizeof text, "user %d   has another scenario", one.user + 1);
  return text;
}

void showUsers(const SessionLook& look, SpectatorWishes& wishes) {
  if (look.users.empty()) ImGui::TextUnformatted("waiting for sites");
  for (const UserLook& one : look.users) {
    const Colour colour = chooseUserColour(one.user);
    ImGui::ColorButton(("##colour" + std::to_string(one.user)).c_str(),
                       {colour.red, colour.green, colour.blue, 1.0F},
                       ImGuiColorEditFlags_NoTooltip);
    ImGui::SameLine();
    if (ImGui::RadioButton(describeUser(one).c_str(), look.followed == one.user) && canFollow(one))
      wishes.followed = one.user;
  }
}

}  // namespace

SpectatorWishes SpectatorPanel::show(const demos::Scenario& scenario, const SessionLook& look,
                                     const std::vector<std::string>& notes) {
  SpectatorWishes wishes;
  wishes.followed = readKeys(look);
  wishes.shows_all = ImGui::IsKeyPressed(GLFW_KEY_HOME, false);
  beginPanel(scenario);
  ImGui::TextUnformatted("Objects as this user has them:");
  showUsers(look, wishes);
  ImGui::Separator();
  char text[32];
  std::snprintf(text, sizeof text, "%.2f mm", 1e3 * look.apart);
  if (scenario.hasObject()) describe("copies apart", text);
  for (const std::string& note : notes) ImGui::TextWrapped("%s", note.c_str());
  ImGui::Checkbox("joints", &details_.joints);
  ImGui::SameLine();
  ImGui::Checkbox("bounds", &details_.bounds);
  wishes.takes_picture = askForPicture();
  ImGui::SameLine();
  showHelp(shows_help_, kHelp);
  ImGui::End();
  return wishes;
}

void labelHands(const SessionLook& look, const Eye& eye) {
  const PictureSize size = shownSize();
  for (const UserLook& one : look.users) {
    const auto seen = projectPoint(eye, size, one.hand_W);
    if (!seen || one.has_another_scenario) continue;
    const ImVec2 at{static_cast<float>(seen->point.x) + kLabelAway,
                    static_cast<float>(seen->point.y) - 2.5F * kLabelAway};
    const int grey = one.is_live ? 20 : 150;
    ImGui::GetBackgroundDrawList()->AddText(at, IM_COL32(grey, grey, grey, 255),
                                            std::to_string(one.user + 1).c_str());
  }
}

}  // namespace tandem::view
