// Columns of a series: the names and units of its diagnostics, in their order.
#pragma once

#include "core/state/system.hpp"

#include <span>
#include <string>
#include <vector>

namespace thalweg::io {

class SeriesColumns {
public:
  // row: any row of the series. Throws InputError if two diagnostics have the same name.
  explicit SeriesColumns(std::span<const Diagnostic> row);

  // First line of the file, without its end: time [s],q_star [1],...
  std::string header() const;

  // Values of a row. Throws std::logic_error unless its names are these, in this order.
  std::vector<double> values_of(std::span<const Diagnostic> row) const;

private:
  struct Column {
    std::string name, unit;  // unit: "1" for none
  };
  std::vector<Column> columns_;
};

}  // namespace thalweg::io
