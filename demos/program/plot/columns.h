#pragma once

#include <string>
#include <vector>

#include "plot/figure.h"
#include "plot/grouping.h"
#include "plot/signals.h"

/// \file
/// Figures with one column of panels per scheme: rows share their axis of values, columns their
/// axis of time, so that schemes compare at a glance.
namespace tandem::demos::plot {

struct Curve {
  Signal t;           // [s]
  Signal y;           // in the unit of the row's label
  std::string style;  // gnuplot style after `with lines`
};

struct PanelRow {
  std::string label;                       // of the axis of values, with unit
  double height = 150;                     // [px]
  std::vector<std::vector<Curve>> panels;  // one per scheme
};

struct ColumnFigure {
  std::string name;
  std::string title;
  std::string caption;
  std::vector<LegendEntry> legend;
  std::vector<std::string> schemes;  // one per column
  std::vector<PanelRow> rows;
  std::vector<std::string> contact;  // stretches of contact, one per scheme; empty: no ribbon
};

[[nodiscard]] Figure drawColumns(const ColumnFigure& columns);

}  // namespace tandem::demos::plot
