#include "scenario/site_checks.h"

#include <fmt/format.h>

#include "scenario/site_delays.h"
#include "scenario/user_places.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

using Refuse = std::function<void(const std::string&)>;

void checkHand(const Scenario& s, const HandScenario& hand, const std::string& site,
               const Refuse& refuse) {
  if (hand.kind == "minimum_jerk" && hand.waypoints.empty())
    refuse(site + ".hand = \"minimum_jerk\": needs " + site + ".hand_waypoints");
  if (hand.kind == "csv" && hand.file.empty())
    refuse(site + ".hand = \"csv\": needs " + site + ".hand_file");
  if (s.guide && s.kind != "playground" && hand.start_offset.tail<2>() != Eigen::Vector2d::Zero())
    refuse(site + ".start_offset: off the axis needs experiment.guide = false");
  if (!hand.grips.empty() && !s.mayGrip()) refuse(site + ".grips: " + kGripNeeds);
}

void checkDelays(const Scenario& s, const Refuse& refuse) {
  const std::size_t count = s.sites.size();
  if (!s.delays.empty() && s.delays.size() != count)
    refuse(fmt::format("network.delays: has {} rows; there are {} sites", s.delays.size(), count));
  for (std::size_t i = 0; i < count; ++i)
    if (!s.delays.empty() && s.sites[i].delay)
      refuse(fmt::format("site{}.delay = {}: network.delays says all delays; leave one of them out",
                         i + 1, *s.sites[i].delay));
  if (s.network.delay > s.duration)
    refuse(fmt::format("network.delay = {}: must not be longer than experiment.duration = {}",
                       s.network.delay, s.duration));
  for (std::size_t from = 0; from < count; ++from)
    for (std::size_t to = 0; to < count; ++to)
      if (from != to && computeDelay(s, from, to) > s.duration)
        refuse(
            fmt::format("the delay from site {} to site {}, {} s: must not be longer than "
                        "experiment.duration = {}",
                        from + 1, to + 1, computeDelay(s, from, to), s.duration));
}

void checkStay(const Scenario& s, const SiteScenario& site, const std::string& name,
               const Refuse& refuse) {
  if (!site.comes && !site.goes) return;
  if (!s.site.membership.follows)
    refuse(name + (site.comes ? ".comes" : ".goes") +
           ": needs coordination.follows_users = true, so that the others share the object anew");
  if (site.goes && *site.goes <= site.comes.value_or(0.0))
    refuse(fmt::format("{}.goes = {}: must be after {}.comes = {}", name, *site.goes, name,
                       site.comes.value_or(0.0)));
}

void checkPlaces(const Scenario& s, const Refuse& refuse) {
  if (s.isWorld() || !s.hasObject()) return;
  const double least = computeLeastFace(s);
  // The message rounds to 1e-5 of it.
  if (s.object_size < (1.0 - 1e-5) * least)
    refuse(
        fmt::format("proxy.radius = {}, object.size = {}: {} users side by side need an "
                    "object.size of {:.6g} at least, or smaller proxies",
                    s.site.proxy.radius, s.object_size, countBeside(s, 0), least));
}

}  // namespace

void checkSites(const Scenario& s, const Refuse& refuse) {
  if (s.sites.size() < kFewestSites)
    refuse(fmt::format("site: there is {} table [[site]]; a scenario has {} to {}", s.sites.size(),
                       kFewestSites, kMostSites));
  for (std::size_t i = 0; i < s.sites.size(); ++i)
    checkHand(s, s.sites[i].hand, fmt::format("site{}", i + 1), refuse);
  for (std::size_t i = 0; i < s.sites.size(); ++i)
    checkStay(s, s.sites[i], fmt::format("site{}", i + 1), refuse);
  checkDelays(s, refuse);
  checkPlaces(s, refuse);
}

}  // namespace tandem::demos
