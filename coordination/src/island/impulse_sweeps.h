#pragma once

#include <cstddef>

#include "island/contact_groups.h"

namespace tandem {

/// Solves a group by sequential impulses (projected Gauss-Seidel), from the rows' impulses. Takes
/// over where ContactSolver does not settle: it always has an answer, if not an exact one. Returns
/// the number of relaxations. Real-time safe.
std::size_t sweepImpulses(const ContactGroups::Group& group) noexcept;

}  // namespace tandem
