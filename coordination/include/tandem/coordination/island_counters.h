#pragma once

#include <cstdint>

#pragma GCC visibility push(default)
namespace tandem {

/// What an island did since Island::prepare(), to see that it does no more than a scene needs. A
/// guided island counts only `advances`.
struct IslandCounters {
  std::uint64_t advances = 0;           ///< calls of Island::advance
  std::uint64_t asleep = 0;             ///< of these, the ones that had nothing to do
  std::uint64_t exact_bodies = 0;       ///< bodies moved by their exact map, one by one
  std::uint64_t exact_turns = 0;        ///< bodies turned exactly, one by one
  std::uint64_t integrated_bodies = 0;  ///< bodies handed to the integrator, one by one
  std::uint64_t integrated_steps = 0;   ///< its steps
  std::uint64_t rejected_steps = 0;     ///< tries that were too long for the tolerance
  std::uint64_t events = 0;             ///< contacts made and broken inside a step
  std::uint64_t contact_searches = 0;   ///< looks at two bodies' exact geometry, to find contact
  std::uint64_t contact_searches_skipped = 0;  ///< pairs whose bounding balls are too far apart
  std::uint64_t repeated = 0;      ///< advances done again because a body alone was met after all
  std::uint64_t rigid_points = 0;  ///< points of rigid contact solved, one by one
  std::uint64_t rigid_relaxations = 0;  ///< of these points, one by one
  std::uint64_t rigid_steps = 0;        ///< inner steps that asked the ContactFinder
  std::uint64_t asleep_bodies = 0;      ///< bodies left out, at rest with nothing near, one by one
  std::uint64_t resting_bodies =
      0;  ///< bodies at rest on something rigid that were not moved, one by one
};

}  // namespace tandem
#pragma GCC visibility pop
