#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tandem/coordination/stability.h"

#include "analyse/jobs.h"

namespace tandem::demos {

/// One curve; an empty value is one that is not there.
struct Curve {
  std::string name;
  std::vector<std::optional<double>> values;
};

/// Curves over the same numbers. Jobs write into `values`: until they are done a set may move, but
/// not be copied.
struct CurveSet {
  std::vector<double> x;
  std::vector<Curve> curves;
};

/// Schemes that a loop can have: virtual coupling needs an object.
[[nodiscard]] std::vector<StandInKind> listStandIns(const LoopSettings& loop);

/// So many equal steps from a delay of 0 to 0.2 s [s].
[[nodiscard]] std::vector<double> listDelays(std::size_t steps);

/// Over the delays of `set`: the least damping of devices with which motion dies out [N s/m], for
/// each scheme. Empty where 200 N s/m are too few.
void addDampingJobs(const LoopSettings& loop, CurveSet& set, Jobs& jobs);

/// Over 2 to 16 users: rates [1/s] with hands that hold, by sum and by average, and around an
/// object by average with whole stand-ins. The object's mass grows with the users.
void addUserJobs(const LoopSettings& loop, CurveSet& set, Jobs& jobs);

/// Over the delays of `set`: the largest coordination stiffness [N/m] of virtual coupling, and what
/// criteria.h says of it. Nothing without an object.
void addCoordinationLimitJobs(const LoopSettings& loop, CurveSet& set, Jobs& jobs);

/// Over the delays of `set`: the largest contact stiffness [N/m] of virtual coupling, or of a
/// kinematic proxy without an object, and what criteria.h says of it.
void addContactLimitJobs(const LoopSettings& loop, CurveSet& set, Jobs& jobs);

/// Over delays in steps of 0.25 ms, up to two packets around the loop's own: the rate [1/s] of each
/// scheme.
void addFineJobs(const LoopSettings& loop, CurveSet& set, Jobs& jobs);

/// Over the damping of the devices, 0 to 3 N s/m: the restitution of a touch of a kinematic proxy,
/// for a quarter of the loop's contact stiffness to twice of it. Nothing with an object.
void addTouchJobs(const LoopSettings& loop, CurveSet& set, Jobs& jobs);

}  // namespace tandem::demos
