#include "dem/grain_sizes.hpp"

#include "core/counter_random.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace thalweg::dem {

double sphere_volume(double diameter) { return std::numbers::pi / 6.0 * diameter * diameter * diameter; }

static void require_sizes_that_fit(SectionVisitor& visit, const SizesKeys& sizes) {
  if (sizes.distribution) {
    visit.require(sizes.median && sizes.geometric_deviation && sizes.minimum && sizes.maximum, "distribution",
                  "a lognormal distribution needs median, minimum and maximum in m and geometric_deviation");
    visit.require(*sizes.minimum < *sizes.maximum && *sizes.minimum <= *sizes.median && *sizes.median <= *sizes.maximum,
                  "median", "minimum, median and maximum must rise in this order");
  }
  visit.require(sizes.sizes.size() == sizes.fractions.size(), "sizes",
                "each size needs its share of the number of grains; give as many fractions as sizes");
  double sum = 0.0;
  for (const double fraction : sizes.fractions) sum += fraction;
  visit.require(sizes.fractions.empty() || (sum > 0.999 && sum < 1.001), "fractions",
                fmt::format("the fractions add up to {:g}; they are shares of the number and must add up to 1", sum));
}

void describe(SectionVisitor& visit, SizesKeys& sizes, double& diameter) {
  std::optional<double> value;
  if (!visit.reading() && !sizes.given()) value = diameter;
  visit.real("value", value, {.unit = "m", .meaning = "of every grain", .above = 0.0, .example = 5e-3});
  visit.choice<SizeDistribution>("distribution", sizes.distribution,
                                 {{SizeDistribution::lognormal, "lognormal", "of the number, with the next four keys"}},
                                 {.meaning = "in place of a value"});
  visit.real("median", sizes.median, {.unit = "m", .meaning = "of lognormal", .above = 0.0, .example = 5e-3});
  visit.real("geometric_deviation", sizes.geometric_deviation,
             {.meaning = "of lognormal: exp of the deviation of ln d", .above = 1.0, .at_most = 3.0, .example = 1.2});
  visit.real("minimum", sizes.minimum, {.unit = "m", .meaning = "nothing finer", .above = 0.0, .example = 3.5e-3});
  visit.real("maximum", sizes.maximum, {.unit = "m", .meaning = "nothing coarser", .above = 0.0, .example = 7e-3});
  visit.real_list("sizes", sizes.sizes,
                  {.unit = "m", .meaning = "a few sizes, in place of a value", .above = 0.0, .example = 5e-3});
  visit.real_list(
      "fractions", sizes.fractions,
      {.meaning = "of the number of grains, one for each size", .above = 0.0, .at_most = 1.0, .example = 0.5});
  if (!visit.reading()) return;
  const int ways = value.has_value() + sizes.distribution.has_value() + !sizes.sizes.empty();
  visit.require(ways == 1, "value", "give exactly one of value in m, distribution, and sizes with fractions");
  if (!sizes.distribution)
    for (const char* key : {"median", "geometric_deviation", "minimum", "maximum"})
      visit.not_here(key, "only a distribution has it; add distribution: lognormal or remove the key");
  require_sizes_that_fit(visit, sizes);
  if (value) diameter = *value;
}

namespace {

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

std::vector<double> lognormal_diameters(const SizesKeys& sizes, std::int64_t count, std::int64_t seed) {
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

std::vector<double> listed_diameters(const SizesKeys& sizes, std::int64_t count, std::int64_t seed) {
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

std::vector<double> sampled_diameters(const SizesKeys& sizes, std::int64_t count, std::int64_t seed) {
  return sizes.distribution ? lognormal_diameters(sizes, count, seed) : listed_diameters(sizes, count, seed);
}

}  // namespace thalweg::dem
