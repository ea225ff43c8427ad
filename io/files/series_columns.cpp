#include "io/files/series_columns.hpp"

#include "core/base/error.hpp"

#include <fmt/format.h>

#include <set>
#include <stdexcept>

namespace thalweg::io {

SeriesColumns::SeriesColumns(std::span<const Diagnostic> row) {
  std::set<std::string> names{"time"};
  for (const Diagnostic& diagnostic : row) {
    if (!names.insert(diagnostic.name).second)
      throw InputError(
          fmt::format("Two columns of the series have the name {}; rename the population or the probe that "
                      "it belongs to, or remove one of the sections of analysis that measure it.",
                      diagnostic.name));
    columns_.push_back({diagnostic.name, diagnostic.unit});
  }
}

std::string SeriesColumns::header() const {
  std::string header = "time [s]";
  for (const Column& column : columns_) header += fmt::format(",{} [{}]", column.name, column.unit);
  return header;
}

std::vector<double> SeriesColumns::values_of(std::span<const Diagnostic> row) const {
  if (row.size() != columns_.size())
    throw std::logic_error(
        fmt::format("a row of the series has {} values for {} columns", row.size(), columns_.size()));
  std::vector<double> values;
  for (std::size_t n = 0; n < row.size(); ++n) {
    if (row[n].name != columns_[n].name)
      throw std::logic_error(fmt::format("a row of the series has {} in column {}", row[n].name, columns_[n].name));
    values.push_back(row[n].value);
  }
  return values;
}

}  // namespace thalweg::io
