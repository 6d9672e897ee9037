#include "plot/reference.h"

#include <cmath>

namespace tandem::demos::plot {
namespace {

// "The paper": Li & Constantinescu 2009, its equations (1)-(14) integrated at 2 us with the device
// force held over 1 ms and packets at 128 Hz held until the next.
constexpr RunKind kI = RunKind::kCooperation;
constexpr RunKind kII = RunKind::kUserContact;
constexpr double kOpen = kMissing;
constexpr ReferenceOutcome kPaper[] = {
    {"virtual_coupling", kI, 4000, 0.05, 10.94e-3, 13.40e-3, 20.7e-3, 0.59e-3, 4.876, kOpen, kOpen,
     kOpen},
    {"kinematic_proxy", kI, 4000, 0.05, 3.16e-3, 12.83e-3, 7.3e-3, 1.30e-3, 4.955, kOpen, kOpen,
     kOpen},
    {"remote_dynamic_proxy", kI, 4000, 0.05, 6.31e-3, 10.07e-3, 12.7e-3, 0.40e-3, 4.921, kOpen,
     kOpen, kOpen},
    {"kinematic_proxy", kII, 2000, 0.1, kOpen, kOpen, kOpen, kOpen, kOpen, 8.7, 25, kOpen},
    {"kinematic_proxy", kII, 2000, 0.2, kOpen, kOpen, kOpen, kOpen, kOpen, 7.8, 23, kOpen},
    {"kinematic_proxy", kII, 4000, 0.1, kOpen, kOpen, kOpen, kOpen, kOpen, 14.2, 88, kOpen},
    {"remote_dynamic_proxy", kII, 2000, 0.1, kOpen, kOpen, kOpen, kOpen, kOpen, 3.52, 1, 0.1919},
    {"remote_dynamic_proxy", kII, 2000, 0.2, kOpen, kOpen, kOpen, kOpen, kOpen, 3.52, 1, 0.1150},
    {"remote_dynamic_proxy", kII, 4000, 0.1, kOpen, kOpen, kOpen, kOpen, kOpen, 3.60, 1, 0.1790},
};

struct Asked {
  const char* pointer;
  double cooperation;
  double contact;
};

// Contact stiffness and delay are in the table above: they tell its cases apart.
constexpr Asked kAsked[] = {
    {"/experiment/duration", 1.0, 2.0},
    {"/contact/damping", 1.0, 1.0},
    {"/coordination/stiffness", 200, 200},
    {"/coordination/damping", 30, 10},
    {"/proxy/mass", 0.1, 0.1},
    {"/proxy/damping", 0.0, 0.0},
    {"/device/mass", 0.1, 0.1},
    {"/device/damping", 0.5, 0.5},
    {"/site1/hand_force/0", 5.0, 3.0},
    {"/site1/hand_force/1", 0.0, 0.0},
    {"/site1/hand_force/2", 0.0, 0.0},
    {"/site2/hand_force/0", 0.0, 0.0},
    {"/site2/hand_force/1", 0.0, 0.0},
    {"/site2/hand_force/2", 0.0, 0.0},
    {"/network/rate", 128, 128},
    {"/rates/haptic", 1000, 1000},
};
constexpr Asked kAskedObject[] = {{"/object/mass", 0.2, 0.2}, {"/object/damping", 0.0, 0.0}};
// Zero or not mentioned: what the paper does not have.
constexpr const char* kAbsent[] = {
    "/network/jitter",       "/network/loss",         "/network/duplicate",
    "/network/reorder",      "/world/gravity",        "/device/encoder_resolution",
    "/site1/start_offset/0", "/site1/start_offset/1", "/site1/start_offset/2",
    "/site2/start_offset/0", "/site2/start_offset/1", "/site2/start_offset/2"};

bool isNear(double a, double b) { return std::abs(a - b) <= 1e-9 * (1.0 + std::abs(b)); }

bool hasAsked(const Run& run, const Asked& asked) {
  return isNear(run.setting(asked.pointer),
                run.kind == RunKind::kCooperation ? asked.cooperation : asked.contact);
}

bool isConstantHand(const Run& run, const std::string& site) {
  const std::string hand = run.settingText("/" + site + "/hand");
  return hand.empty() || hand == "constant";
}

bool hasPaperSettings(const Run& run) {
  if (!isConstantHand(run, "site1") || !isConstantHand(run, "site2")) return false;
  for (const Asked& asked : kAsked)
    if (!hasAsked(run, asked)) return false;
  if (run.kind == RunKind::kCooperation)
    for (const Asked& asked : kAskedObject)
      if (!hasAsked(run, asked)) return false;
  for (const char* pointer : kAbsent)
    if (const double amount = run.setting(pointer); std::isfinite(amount) && amount != 0.0)
      return false;
  return true;
}

}  // namespace

const ReferenceOutcome* referenceOf(const Run& run) {
  if (run.kind == RunKind::kPlayground || !hasPaperSettings(run)) return nullptr;
  for (const ReferenceOutcome& row : kPaper)
    if (row.scheme == run.scheme && row.kind == run.kind &&
        isNear(run.setting("/contact/stiffness"), row.contact_stiffness) &&
        isNear(run.setting("/network/delay"), row.network_delay))
      return &row;
  return nullptr;
}

}  // namespace tandem::demos::plot
