#pragma once

#include <cstdint>

#pragma GCC visibility push(default)
namespace tandem {

/// Work of an island since Island::prepare(), which reveals needless work. A guided island counts
/// only `advances`.
struct IslandCounters {
  std::uint64_t advances = 0;           ///< calls of Island::advance
  std::uint64_t asleep = 0;             ///< calls that had nothing to do
  std::uint64_t exact_bodies = 0;       ///< moves by a body's exact map
  std::uint64_t exact_turns = 0;        ///< exact turns of a body
  std::uint64_t integrated_bodies = 0;  ///< bodies handed to the integrator
  std::uint64_t integrated_steps = 0;   ///< steps of the integrator
  std::uint64_t steps_of_order_4 = 0;   ///< those of them that were of order 4, with joints
  std::uint64_t rejected_steps = 0;     ///< integrator steps rejected as too long for the tolerance
  std::uint64_t events = 0;             ///< contacts made and broken inside a step
  std::uint64_t event_tries = 0;        ///< steps tried to find their moments
  std::uint64_t contact_searches = 0;   ///< exact geometry queries of a pair of bodies
  std::uint64_t contact_searches_skipped = 0;  ///< pairs whose bounding spheres are far apart
  std::uint64_t repeated = 0;      ///< advances repeated because a body moved alone met another
  std::uint64_t rigid_points = 0;  ///< rigid contact points solved
  std::uint64_t rigid_relaxations = 0;     ///< relaxations of rigid contact points
  std::uint64_t rigid_steps = 0;           ///< inner steps that called the ContactFinder
  std::uint64_t rigid_factorisations = 0;  ///< matrices factorised to solve rigid contact
  std::uint64_t rigid_bounded = 0;   ///< advances cut short, as rigid contact was too much work
  std::uint64_t asleep_bodies = 0;   ///< bodies skipped at rest with nothing near
  std::uint64_t resting_bodies = 0;  ///< bodies at rest on a rigid contact that were not moved
};

}  // namespace tandem
#pragma GCC visibility pop
