// Refused calls on sites.

#include "c_door/refusal_rig.h"

namespace tandem {
namespace {

using namespace test;

TandemSiteSettings spoilSite(const std::function<void(TandemSiteSettings&)>& spoil) {
  TandemSiteSettings settings = tandem_default_site_settings();
  spoil(settings);
  return settings;
}

Case siteCase(const char* name, const char* words,
              const std::function<void(TandemSiteSettings&)>& spoil) {
  return {name, TANDEM_INVALID_ARGUMENT, words, [spoil](Scene& scene) {
            const TandemSiteSettings settings = spoilSite(spoil);
            TandemSite* site = untouched<TandemSite>();
            const TandemResult result =
                tandem_site_create(&settings, scene.bare, scene.spare, &site);
            EXPECT_EQ(site, untouched<TandemSite>());
            return result;
          }};
}

std::vector<Case> siteCases() {
  return {
      siteCase("Cookie", "not from tandem_default_site_settings()",
               [](auto& s) { s = TandemSiteSettings{}; }),
      siteCase("Self", "self = 0: must be 1 or more", [](auto& s) { s.self = 0; }),
      siteCase("Peers", "peers = 0: must be 1 to 64", [](auto& s) { s.peers = 0; }),
      siteCase("Rate", "haptic_rate = nan", [](auto& s) { s.haptic_rate = kNan; }),
      siteCase("Budget", "packet_budget = -1: must be", [](auto& s) { s.packet_budget = -1.0; }),
      siteCase("Contact", "contact.stiffness = -1", [](auto& s) { s.contact.stiffness = -1.0; }),
      siteCase("Scheme", "remote_dynamic_proxy", [](auto& s) { s.scheme = "telepathy"; }),
      siteCase("NoScheme", "scheme is null", [](auto& s) { s.scheme = nullptr; }),
      siteCase("Guide", "guide = (1, 1, 0): must be of length 1",
               [](auto& s) { s.has_guide = 1, s.guide[1] = 1.0; }),
      siteCase("CoordinationMode", "coordination_mode = 2: must be TANDEM_COORDINATION_SUM or",
               [](auto& s) { setNumber(s.coordination_mode, 2); }),
      siteCase("TickSource", "tick_source", [](auto& s) { setNumber(s.tick_source, 3); }),
      {"DeviceTaken", TANDEM_IN_USE, "the device belongs to another site",
       [](Scene& scene) {
         const TandemSiteSettings settings = tandem_default_site_settings();
         TandemSite* site = nullptr;
         return tandem_site_create(&settings, scene.bare, scene.device, &site);
       }},
      {"WorldTaken", TANDEM_CANNOT, "this Bullet world is attached already",
       [](Scene& scene) {
         const TandemSiteSettings settings = tandem_default_site_settings();
         TandemSite* site = nullptr;
         return tandem_site_create(&settings, scene.world, scene.spare, &site);
       }},
      {"ShiftOwnWorld", TANDEM_CANNOT, "a world of Tandem's keeps its origin",
       [](Scene& scene) {
         const double offset[3] = {1.0, 0.0, 0.0};
         return tandem_site_shift_origin(scene.site, offset);
       }},
      {"ShiftByNan", TANDEM_INVALID_ARGUMENT, "offset",
       [](Scene& scene) {
         const double offset[3] = {1.0, kNan, 0.0};
         return tandem_site_shift_origin(scene.site, offset);
       }},
      {"ShareStatic", TANDEM_CANNOT, "is static; give a shared object a mass",
       [](Scene& scene) { return tandem_site_share(scene.site, scene.wall, 0.0, nullptr); }},
      {"ShareTwice", TANDEM_CANNOT, "is shared already",
       [](Scene& scene) { return tandem_site_share(scene.site, scene.cube, 0.0, nullptr); }},
      {"ShareProxy", TANDEM_CANNOT, "is shared already, or a proxy",
       [](Scene& scene) { return tandem_site_share(scene.site, scene.proxy, 0.0, nullptr); }},
      {"ShareDamping", TANDEM_INVALID_ARGUMENT, "damping = -1",
       [](Scene& scene) { return tandem_site_share(scene.site, scene.cube, -1.0, nullptr); }},
      {"UnshareUnknown", TANDEM_INVALID_ARGUMENT, "there is no object 3; this site has 1",
       [](Scene& scene) { return tandem_site_unshare(scene.site, 3); }},
      {"ShareAgainUnknown", TANDEM_INVALID_ARGUMENT, "there is no object 3",
       [](Scene& scene) { return tandem_site_share_again(scene.site, 3, scene.cube); }},
      {"ShareAgainHeld", TANDEM_CANNOT, "object 0 has a body in the world; unshare it first",
       [](Scene& scene) { return tandem_site_share_again(scene.site, 0, scene.cube); }},
      {"ShareAgainStatic", TANDEM_CANNOT, "is static; give a shared object a mass",
       [](Scene& scene) { return tandem_site_share_again(scene.site, 0, scene.wall); }},
      {"ShareAgainProxy", TANDEM_CANNOT, "is shared already, or a proxy",
       [](Scene& scene) { return tandem_site_share_again(scene.site, 0, scene.proxy); }},
      {"StateUnknown", TANDEM_INVALID_ARGUMENT, "there is no object 1",
       [](Scene& scene) {
         TandemObjectState state{};
         return tandem_site_object_state(scene.site, 1, &state);
       }},
      {"StateNull", TANDEM_INVALID_ARGUMENT, "state is null",
       [](Scene& scene) { return tandem_site_object_state(scene.site, 0, nullptr); }},
      {"ConnectTwice", TANDEM_CANNOT, "peer 2 is connected already",
       [](Scene& scene) {
         return tandem_site_connect(scene.site, 2, scene.loose, test::kNothing, nullptr);
       }},
      {"ConnectSelf", TANDEM_INVALID_ARGUMENT, "cannot be its own remote",
       [](Scene& scene) {
         return tandem_site_connect(scene.site, 1, scene.loose, test::kNothing, nullptr);
       }},
      {"ConnectNobody", TANDEM_INVALID_ARGUMENT, "peer = 0",
       [](Scene& scene) {
         return tandem_site_connect(scene.site, 0, scene.loose, test::kNothing, nullptr);
       }},
      {"ConnectTakenLink", TANDEM_IN_USE, "the link is connected already",
       [](Scene& scene) {
         return tandem_site_connect(scene.site, 3, scene.link, test::kNothing, nullptr);
       }},
      {"ConnectNan", TANDEM_INVALID_ARGUMENT, "start = (nan, 0, 0)",
       [](Scene& scene) {
         const double start[3] = {kNan, 0.0, 0.0};
         return tandem_site_connect(scene.site, 3, scene.loose, start, nullptr);
       }},
      {"TickItself", TANDEM_INVALID_ARGUMENT, "make it with TANDEM_TICK_CALLER",
       [](Scene& scene) { return tandem_site_tick(scene.site, 1.0, nullptr); }},
      {"LoopOfHostStep", TANDEM_INVALID_ARGUMENT, "TickSource::kCaller",
       [](Scene& scene) { return tandem_site_start_loop(scene.site, 0); }},
      {"WarningsNull", TANDEM_INVALID_ARGUMENT, "text is null",
       [](Scene& scene) { return tandem_site_warnings(scene.site, nullptr, 10, nullptr); }},
  };
}

INSTANTIATE_TEST_SUITE_P(Sites, Refused, ::testing::ValuesIn(siteCases()), nameOf);

}  // namespace
}  // namespace tandem
