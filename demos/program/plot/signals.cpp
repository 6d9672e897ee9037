#include "plot/signals.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tandem::demos::plot {
namespace {

// Sites may differ by a row at the end; what both have is compared.
template <class Combine>
Signal combined(const Signal& a, const Signal& b, Combine combine) {
  Signal out(std::min(a.size(), b.size()));
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = combine(a[i], b[i]);
  return out;
}

double tickOf(const Signal& t) { return t.size() > 1 ? t[1] - t[0] : 0.0; }

}  // namespace

Signal normOf(const Table& table, const std::string& prefix) {
  const Signal& x = table.column(prefix + "_x");
  const Signal& y = table.column(prefix + "_y");
  const Signal& z = table.column(prefix + "_z");
  Signal norm(x.size());
  for (std::size_t i = 0; i < norm.size(); ++i) norm[i] = std::hypot(x[i], y[i], z[i]);
  return norm;
}

Signal separationOf(const std::array<Table, 2>& sites) {
  Signal sum;
  for (const char* column : {"object_x", "object_y", "object_z"}) {
    const Signal along = difference(sites[0].column(column), sites[1].column(column));
    sum.resize(along.size(), 0.0);
    for (std::size_t i = 0; i < along.size(); ++i) sum[i] += along[i] * along[i];
  }
  for (double& value : sum) value = std::sqrt(value);
  return sum;
}

Signal scaled(Signal values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

Signal difference(const Signal& a, const Signal& b) {
  return combined(a, b, [](double p, double q) { return p - q; });
}

Signal average(const Signal& a, const Signal& b) {
  return combined(a, b, [](double p, double q) { return 0.5 * (p + q); });
}

Range recordedTime(const Signal& t) { return Range{t.front(), t.back() + tickOf(t)}.padded(0.0); }

std::string contactStretches(const Table& table) {
  const Signal& t = table.column("t");
  const Signal& contact = table.column("contact");
  std::string rows;
  for (std::size_t begin = 0; begin < t.size();) {
    std::size_t end = begin;
    while (end < t.size() && contact[end] > 0.5) ++end;
    if (end > begin) rows += fmt::format("{:.6g} {:.6g}\n", t[begin], t[end - 1] + tickOf(t));
    begin = end + 1;
  }
  return rows;
}

}  // namespace tandem::demos::plot
