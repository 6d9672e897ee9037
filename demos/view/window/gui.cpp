#include "window/gui.h"

#include <filesystem>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

namespace tandem::view {
namespace {

constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr float kFontSize = 15.0F;  // [pixel]

}  // namespace

Gui::Gui(GLFWwindow* window) {
  ImGui::CreateContext();
  ImGui::StyleColorsLight();
  ImGui::GetStyle().WindowRounding = 6.0F;
  ImGui::GetStyle().FrameBorderSize = 1.0F;  // a box that is not ticked is white on light grey
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // nothing is left behind in the user's folder
  std::error_code ignored;
  if (std::filesystem::exists(kFont, ignored)) io.Fonts->AddFontFromFileTTF(kFont, kFontSize);
  ImGui_ImplGlfw_InitForOpenGL(window, true);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

Gui::~Gui() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Gui::begin() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void Gui::draw() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool Gui::hasPointer() const { return ImGui::GetIO().WantCaptureMouse; }

}  // namespace tandem::view
