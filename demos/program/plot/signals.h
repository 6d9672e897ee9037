#pragma once

#include <string>
#include <vector>

#include "plot/figure.h"
#include "plot/run.h"

namespace tandem::demos::plot {

using Signal = std::vector<double>;

/// Columns `prefix`_x, _y, _z as one length each: |(x, y, z)|.
[[nodiscard]] Signal normOf(const Table& table, const std::string& prefix);

/// |object at site 1 - object at site 2| tick by tick [m].
[[nodiscard]] Signal separationOf(const std::array<Table, 2>& sites);

[[nodiscard]] Signal scaled(Signal values, double factor);
[[nodiscard]] Signal difference(const Signal& a, const Signal& b);
[[nodiscard]] Signal average(const Signal& a, const Signal& b);

/// The time that a recording covers: to the end of its last tick [s].
[[nodiscard]] Range recordedTime(const Signal& t);

/// Rows "begin end" [s], one for each stretch of time with contact.
[[nodiscard]] std::string contactStretches(const Table& table);

}  // namespace tandem::demos::plot
