#include "analysis/bed/bed_height.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::analysis {

namespace {

// Height, in spacings, below which this share of all volume lies.
double height_of_share(const VolumeBelow& below, double share) {
  const double wanted = share * below.volume.back();
  std::size_t k = 1;
  while (k + 1 < below.volume.size() && below.volume[k] < wanted) ++k;
  const double lower = below.volume[k - 1], here = below.volume[k] - lower;
  const double part = here > 0.0 ? (wanted - lower) / here : 0.0;
  return static_cast<double>(k - 1) + part;
}

// O between two heights in spacings, linear between those of `below`; m^3.
double obstacles_between(const VolumeBelow& below, double lower, double upper) {
  if (below.obstacle.empty()) return 0.0;
  const auto at = [&](double height) {
    const std::size_t k = std::min(static_cast<std::size_t>(height), below.obstacle.size() - 2);
    return std::lerp(below.obstacle[k], below.obstacle[k + 1], height - static_cast<double>(k));
  };
  return at(upper) - at(lower);
}

// 0 where obstacles leave no room.
double solid_fraction(const VolumeBelow& below, int at, int half_window) {
  const int top = static_cast<int>(below.volume.size()) - 1;
  const int lower = std::max(0, at - half_window), upper = std::min(top, at + half_window);
  const double whole = below.area * below.spacing * (upper - lower);
  const double room = whole - obstacles_between(below, lower, upper);
  constexpr double rounding = 1e-9;
  if (room <= rounding * whole) return 0.0;
  return (below.volume[static_cast<std::size_t>(upper)] - below.volume[static_cast<std::size_t>(lower)]) / room;
}

}  // namespace

int thin_layers(double box_height, double window) {
  return std::max(1, static_cast<int>(std::lround(thin_layers_a_window * box_height / window)));
}

double obstacles_above(const VolumeBelow& below, double height) {
  return obstacles_between(below, height / below.spacing, static_cast<double>(below.volume.size() - 1));
}

double bulk_solid_fraction(const VolumeBelow& below) {
  constexpr double lower = 0.1, upper = 0.5;  // shares of the volume
  const double whole = below.volume.back();
  const double from = height_of_share(below, lower), to = height_of_share(below, upper);
  const double height = to * below.spacing - from * below.spacing;
  const double room = below.area * height - obstacles_between(below, from, to);
  return room > 0.0 ? (upper - lower) * whole / room : 0.0;
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
