#include "analysis/bed_height.hpp"

#include <algorithm>

namespace thalweg::analysis {

namespace {

// Below which this share of all volume lies; m.
double height_of_share(const VolumeBelow& below, double share) {
  const double wanted = share * below.volume.back();
  std::size_t k = 1;
  while (k + 1 < below.volume.size() && below.volume[k] < wanted) ++k;
  const double lower = below.volume[k - 1], here = below.volume[k] - lower;
  const double part = here > 0.0 ? (wanted - lower) / here : 0.0;
  return (static_cast<double>(k - 1) + part) * below.spacing;
}

double solid_fraction(const VolumeBelow& below, int at, int half_window) {
  const int top = static_cast<int>(below.volume.size()) - 1;
  const int lower = std::max(0, at - half_window), upper = std::min(top, at + half_window);
  return (below.volume[static_cast<std::size_t>(upper)] - below.volume[static_cast<std::size_t>(lower)]) /
         (below.area * below.spacing * (upper - lower));
}

}  // namespace

double bulk_solid_fraction(const VolumeBelow& below) {
  constexpr double lower = 0.1, upper = 0.5;  // shares of the volume
  const double whole = below.volume.back();
  const double height = height_of_share(below, upper) - height_of_share(below, lower);
  return height > 0.0 ? (upper - lower) * whole / (below.area * height) : 0.0;
}

double bed_height(const VolumeBelow& below, int half_window) {
  const double half = 0.5 * bulk_solid_fraction(below);
  if (half == 0.0) return 0.0;
  const int top = static_cast<int>(below.volume.size()) - 1;
  double above = 0.0;
  for (int k = top; k >= 0; --k) {
    const double here = solid_fraction(below, k, half_window);
    if (here >= half) {
      const double part = k < top ? (here - half) / (here - above) : 0.0;
      return (k + part) * below.spacing;
    }
    above = here;
  }
  return 0.0;
}

}  // namespace thalweg::analysis
