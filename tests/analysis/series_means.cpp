// Mean, error and trend of the numbers on the standard input, for a comparison with the same in Python: one a line,
// mean, error, deviation, independent values, drift, its error, and the verdict as a sentence.
#include "analysis/statistics/stationarity.hpp"

#include <fmt/format.h>

#include <iostream>

int main() {
  thalweg::analysis::CorrelatedMean series;
  for (double value; std::cin >> value;) series.add(value);
  const auto error = series.error();
  const auto trend = thalweg::analysis::trend_of(series);
  for (const double number :
       {series.mean(), error.of_mean, series.deviation(), error.independent, trend.drift, trend.error})
    fmt::print("{:.17g}\n", number);
  fmt::print("{}\n", trend.sentence(1.0));
}
