// Sections of a reach: planes across x at equal distances, and the bins of the bed between them. Section k lies at the
// lower face of bin k; where x is periodic, section 0 is the end of the last bin, too.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace thalweg::analysis {

struct Sections {
  double length;  // m, of the box along x
  std::int64_t bins;
  bool periodic;

  double spacing() const { return length / static_cast<double>(bins); }  // m
  std::size_t size() const { return static_cast<std::size_t>(bins); }

  // The bin of a place x (m) in the box.
  std::int64_t bin_of(double x) const {
    const auto bin = static_cast<std::int64_t>(std::floor(x / length * static_cast<double>(bins)));
    return std::clamp<std::int64_t>(bin, 0, bins - 1);
  }
  std::int64_t inside(std::int64_t number) const { return (number % bins + bins) % bins; }

  // The first section that results show: section 0 of a reach with ends is a face of the box, which no centre crosses.
  std::size_t first() const { return periodic ? 0 : 1; }
  std::vector<double> places() const {  // m, of the sections from the first() one on
    std::vector<double> x;
    for (std::size_t k = first(); k < size(); ++k) x.push_back(static_cast<double>(k) * spacing());
    return x;
  }
  std::vector<double> middles() const {  // m, of the bins
    std::vector<double> x;
    for (std::size_t b = 0; b < size(); ++b) x.push_back((static_cast<double>(b) + 0.5) * spacing());
    return x;
  }
};

}  // namespace thalweg::analysis
