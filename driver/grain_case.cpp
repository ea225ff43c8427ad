#include "driver/grain_case.hpp"

#include "core/counter_random.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace thalweg {
namespace {

double sphere_volume(double diameter) { return std::numbers::pi / 6.0 * diameter * diameter * diameter; }

double volume_of(double diameter, double thickness) {
  return thickness > 0.0 ? std::numbers::pi / 4.0 * diameter * diameter * thickness : sphere_volume(diameter);
}

// The draw of counter_random.hpp that sizes use; placements use small numbers.
constexpr std::uint64_t size_draw = std::uint64_t{1} << 40;

// For every grain, its place (0 ... count - 1) among the random numbers of all.
std::vector<std::size_t> shuffled_places(std::int64_t count, std::int64_t seed) {
  std::vector<std::size_t> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t grain) {
    return uniform_random(static_cast<std::uint64_t>(seed), grain, size_draw);
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const double ka = key(a), kb = key(b);
    return ka != kb ? ka < kb : a < b;
  });
  std::vector<std::size_t> place(order.size());
  for (std::size_t p = 0; p < order.size(); ++p) place[order[p]] = p;
  return place;
}

double normal_share_below(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

// The x below which this share (0 < share < 1) of the normal distribution lies, by bisection between two bounds.
double normal_quantile(double share, double lower, double upper) {
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (lower + upper);
    (normal_share_below(middle) < share ? lower : upper) = middle;
  }
  return 0.5 * (lower + upper);
}

std::vector<double> lognormal_diameters(const SizesCase& sizes, std::int64_t count, std::int64_t seed) {
  const double deviation = std::log(*sizes.geometric_deviation);
  const double lower = std::log(*sizes.minimum / *sizes.median) / deviation;
  const double upper = std::log(*sizes.maximum / *sizes.median) / deviation;
  const double first = normal_share_below(lower), last = normal_share_below(upper);
  std::vector<double> diameters;
  for (const std::size_t place : shuffled_places(count, seed)) {
    const double share = (static_cast<double>(place) + 0.5) / static_cast<double>(count);
    const double x = normal_quantile(first + share * (last - first), lower, upper);
    diameters.push_back(std::clamp(*sizes.median * std::exp(deviation * x), *sizes.minimum, *sizes.maximum));
  }
  return diameters;
}

std::vector<double> listed_diameters(const SizesCase& sizes, std::int64_t count, std::int64_t seed) {
  const double whole = std::accumulate(sizes.fractions.begin(), sizes.fractions.end(), 0.0);
  std::vector<double> by_place;
  double below = 0.0;
  for (std::size_t n = 0; n < sizes.sizes.size(); ++n) {
    below += sizes.fractions[n];
    const auto end = static_cast<std::size_t>(std::llround(below / whole * static_cast<double>(count)));
    by_place.resize(end, sizes.sizes[n]);
  }
  std::vector<double> diameters;
  for (const std::size_t place : shuffled_places(count, seed)) diameters.push_back(by_place[place]);
  return diameters;
}

}  // namespace

std::int64_t PopulationCase::row_count() const {
  if (!file.empty()) return static_cast<std::int64_t>(file.size());
  return shape ? count * static_cast<std::int64_t>(shape->clump.size()) : count;
}

double PopulationCase::smallest_diameter() const {
  if (!shape) return diameters.empty() ? diameter : *std::min_element(diameters.begin(), diameters.end());
  double smallest = std::numeric_limits<double>::infinity();
  for (const MemberCase& member : shape->clump) smallest = std::min(smallest, member.diameter);
  return smallest;
}

double PopulationCase::largest_diameter() const {
  if (!shape) return diameters.empty() ? diameter : *std::max_element(diameters.begin(), diameters.end());
  double largest = 0.0;
  for (const MemberCase& member : shape->clump) largest = std::max(largest, member.diameter);
  return largest;
}

double PopulationCase::largest_extent() const { return std::max(largest_diameter(), clumps.largest_extent); }

double PopulationCase::lightest_mass() const {
  if (shape) return clumps.least_contact_mass;
  if (file.empty()) return density * volume_of(smallest_diameter(), thickness);
  double lightest = clumps.count > 0 ? clumps.least_contact_mass : std::numeric_limits<double>::max();
  for (const io::BedGrain& grain : file)
    if (grain.clump < 0) lightest = std::min(lightest, grain.density * volume_of(2.0 * grain.radius, thickness));
  return lightest;
}

double PopulationCase::volume() const {
  if (shape) return clumps.volume;
  if (diameters.empty()) return static_cast<double>(count) * volume_of(diameter, thickness);
  double sum = clumps.volume;
  for (std::size_t n = 0; n < diameters.size(); ++n)
    if (file.empty() || file[n].clump < 0) sum += volume_of(diameters[n], thickness);
  return sum;
}

double median_by_volume(std::vector<double> diameters) {
  std::sort(diameters.begin(), diameters.end());
  double whole = 0.0, below = 0.0;
  for (const double d : diameters) whole += sphere_volume(d);
  for (const double d : diameters) {
    below += sphere_volume(d);
    if (below >= 0.5 * whole) return d;
  }
  return diameters.empty() ? 0.0 : diameters.back();
}

std::vector<double> sampled_diameters(const SizesCase& sizes, std::int64_t count, std::int64_t seed) {
  return sizes.distribution ? lognormal_diameters(sizes, count, seed) : listed_diameters(sizes, count, seed);
}

}  // namespace thalweg
