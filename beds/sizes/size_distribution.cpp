#include "beds/sizes/size_distribution.hpp"

#include "beds/sizes/grading_curve.hpp"
#include "beds/sizes/normal_distribution.hpp"
#include "core/base/counter_random.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace thalweg::beds {

double sphere_volume(double diameter) { return std::numbers::pi / 6.0 * diameter * diameter * diameter; }

static void require_shares_of_the_number(SectionVisitor& visit, const SizesKeys& sizes) {
  visit.require(sizes.sizes.size() == sizes.fractions.size(), "sizes",
                "each size needs its share of the number of grains; give as many fractions as sizes");
  double sum = 0.0;
  for (const double fraction : sizes.fractions) sum += fraction;
  visit.require(sizes.fractions.empty() || (sum > 0.999 && sum < 1.001), "fractions",
                fmt::format("the fractions add up to {:g}; they are shares of the number and must add up to 1", sum));
}

static void require_cuts_that_fit(SectionVisitor& visit, const SizesKeys& sizes) {
  if (sizes.distribution) {
    visit.require(sizes.median && sizes.geometric_deviation && sizes.minimum && sizes.maximum, "distribution",
                  "a lognormal distribution needs median, minimum and maximum in m and geometric_deviation");
    visit.require(*sizes.minimum < *sizes.maximum && *sizes.minimum <= *sizes.median && *sizes.median <= *sizes.maximum,
                  "median", "minimum, median and maximum must rise in this order");
    return;
  }
  const std::string reason = "only a distribution has it; add distribution: lognormal or remove the key";
  for (const char* key : {"median", "geometric_deviation"}) visit.not_here(key, reason);
  if (sizes.d50) return;
  for (const char* key : {"minimum", "maximum"}) visit.not_here(key, reason);
}

// Sizes that a curve by mass can tell apart, and no more than a few million of the finest to one of the coarsest.
constexpr double closest_sizes = 1.001, widest_sizes = 100.0;

static bool rise(const std::vector<double>& sizes) {
  return std::adjacent_find(sizes.begin(), sizes.end(), [](double below, double above) {
           return !(above >= closest_sizes * below);
         }) == sizes.end();
}

static void describe(SectionVisitor& visit, SieveKeys& sieve) {
  visit.real_list("sizes", sieve.sizes,
                  {.unit = "m",
                   .meaning = "of the sieves, in rising order",
                   .required = true,
                   .above = 0.0,
                   .examples = {2e-3, 4e-3, 8e-3}});
  visit.real_list("finer", sieve.finer,
                  {.meaning = "share of the mass that passes each sieve, from 0 to 1; linear in ln d between sieves",
                   .required = true,
                   .at_least = 0.0,
                   .at_most = 1.0,
                   .examples = {0.0, 0.4, 1.0}});
  if (!visit.reading()) return;
  visit.require(sieve.sizes.size() >= 2 && rise(sieve.sizes), "sizes",
                "give at least two sieves in m, each at least 0.1 % wider than the one before");
  if (sieve.sizes.empty() || sieve.finer.empty()) return;  // missing, which is said when all is read
  visit.require(
      sieve.sizes.back() <= widest_sizes * sieve.sizes.front(), "sizes",
      fmt::format("the widest sieve can be at most {:g} times the finest; leave out the finest", widest_sizes));
  visit.require(sieve.finer.size() == sieve.sizes.size(), "finer", "give as many shares of the mass as sieves");
  visit.require(
      std::is_sorted(sieve.finer.begin(), sieve.finer.end()) && sieve.finer.front() == 0.0 && sieve.finer.back() == 1.0,
      "finer", "the shares of the mass that are finer must rise from 0 at the first sieve to 1 at the last");
}

static void describe_percentiles(SectionVisitor& visit, SizesKeys& sizes) {
  const auto percentile = [&visit](const char* key, std::optional<double>& size, const char* meaning, double example) {
    visit.real(key, size, {.unit = "m", .meaning = meaning, .above = 0.0, .example = example});
  };
  percentile("d16", sizes.d16, "0.16 of the mass is finer; with d50 and d84, lognormal between them", 4e-3);
  percentile("d50", sizes.d50, "half of the mass is finer", 5e-3);
  percentile("d84", sizes.d84, "0.84 of the mass is finer", 6e-3);
  if (!visit.reading() || !(sizes.d16 || sizes.d50 || sizes.d84)) return;
  visit.require(sizes.d16 && sizes.d50 && sizes.d84, sizes.d16 ? "d16" : (sizes.d50 ? "d50" : "d84"),
                "give d16, d50 and d84 together, in m");
  const double minimum = sizes.minimum.value_or(*sizes.d16 * *sizes.d16 / *sizes.d50);
  const double maximum = sizes.maximum.value_or(*sizes.d84 * *sizes.d84 / *sizes.d50);
  visit.require(rise({minimum, *sizes.d16, *sizes.d50, *sizes.d84, maximum}), "d50",
                "minimum, d16, d50, d84 and maximum must rise in this order, by at least 0.1 % each");
  visit.require(maximum <= widest_sizes * minimum, "d50",
                fmt::format("the sizes reach from {:.4g} to {:.4g} m, but the largest can be at most {:g} times the "
                            "smallest; give a larger minimum in m",
                            minimum, maximum, widest_sizes));
}

void describe(SectionVisitor& visit, SizesKeys& sizes, double& diameter) {
  std::optional<double> value;
  if (!visit.reading() && !sizes.given()) value = diameter;
  visit.real("value", value, {.unit = "m", .meaning = "of every grain", .above = 0.0, .example = 5e-3});
  visit.choice<SizeDistribution>("distribution", sizes.distribution,
                                 {{SizeDistribution::lognormal, "lognormal", "by number, with the next four keys"}},
                                 {.meaning = "in place of a value"});
  visit.real("median", sizes.median, {.unit = "m", .meaning = "of lognormal", .above = 0.0, .example = 5e-3});
  visit.real("geometric_deviation", sizes.geometric_deviation,
             {.meaning = "of lognormal: exp of the deviation of ln d", .above = 1.0, .at_most = 3.0, .example = 1.2});
  visit.real("minimum", sizes.minimum,
             {.unit = "m", .meaning = "of all grains; default with d16: d16^2/d50", .above = 0.0, .example = 3.5e-3});
  visit.real("maximum", sizes.maximum,
             {.unit = "m", .meaning = "of all grains; default with d84: d84^2/d50", .above = 0.0, .example = 7e-3});
  visit.real_list("sizes", sizes.sizes,
                  {.unit = "m", .meaning = "a few sizes, in place of a value", .above = 0.0, .examples = {4e-3, 5e-3}});
  visit.real_list(
      "fractions", sizes.fractions,
      {.meaning = "of the number of grains, one for each size", .above = 0.0, .at_most = 1.0, .example = 0.5});
  visit.section("sieve", sizes.sieve, {.meaning = "the sizes by mass, in place of a value"});
  describe_percentiles(visit, sizes);
  if (!visit.reading()) return;
  const int ways = value.has_value() + sizes.distribution.has_value() + !sizes.sizes.empty() + sizes.sieve.has_value() +
                   sizes.d50.has_value();
  visit.require(ways == 1, "value",
                "give exactly one of value in m, distribution, sizes with fractions, sieve, and d16 with d50 and d84");
  require_cuts_that_fit(visit, sizes);
  require_shares_of_the_number(visit, sizes);
  if (value) diameter = *value;
}

namespace {

// The draw of counter_random.hpp that sizes use; placements use small numbers.
constexpr std::uint64_t size_draw = std::uint64_t{1} << 40;

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

std::vector<double> listed_diameters(const SizesKeys& sizes, std::int64_t count) {
  const double whole = std::accumulate(sizes.fractions.begin(), sizes.fractions.end(), 0.0);
  std::vector<double> by_place;
  double below = 0.0;
  for (std::size_t n = 0; n < sizes.sizes.size(); ++n) {
    below += sizes.fractions[n];
    const auto end = static_cast<std::size_t>(std::llround(below / whole * static_cast<double>(count)));
    by_place.resize(end, sizes.sizes[n]);
  }
  return by_place;
}

GradingCurve mass_curve(const SizesKeys& sizes) {
  if (sizes.sieve) return {sizes.sieve->sizes, sizes.sieve->finer};
  const double d16 = *sizes.d16, d50 = *sizes.d50, d84 = *sizes.d84;
  return curve_through(sizes.minimum.value_or(d16 * d16 / d50), d16, d50, d84, sizes.maximum.value_or(d84 * d84 / d50));
}

}  // namespace

std::vector<SizeCount> counted(std::vector<double> diameters) {
  std::sort(diameters.begin(), diameters.end());
  std::vector<SizeCount> sizes;
  for (const double diameter : diameters) {
    if (sizes.empty() || sizes.back().diameter != diameter) sizes.push_back({diameter, 0});
    ++sizes.back().count;
  }
  return sizes;
}

std::vector<SizeCount> merged(std::vector<SizeCount> sizes) {
  std::sort(sizes.begin(), sizes.end(), [](const SizeCount& a, const SizeCount& b) { return a.diameter < b.diameter; });
  std::size_t last = 0;
  for (std::size_t n = 1; n < sizes.size(); ++n) {
    if (sizes[n].diameter == sizes[last].diameter)
      sizes[last].count += sizes[n].count;
    else
      sizes[++last] = sizes[n];
  }
  if (!sizes.empty()) sizes.resize(last + 1);
  return sizes;
}

// Grain by grain: the sums, and so the grain that they end with where two share the middle, are those of a list with
// one entry a grain.
double median_by_mass(std::span<const SizeCount> sizes, bool disks) {
  const auto mass = [disks](double d) { return disks ? d * d : sphere_volume(d); };
  // Grain by grain, so that two halves are equal to the last bit; of a million of one size that does not matter.
  constexpr std::int64_t one_by_one = 1000000;
  const auto add = [&mass](const SizeCount& size, double& sum) {
    if (size.count > one_by_one) sum += static_cast<double>(size.count) * mass(size.diameter);
    for (std::int64_t n = 0; size.count <= one_by_one && n < size.count; ++n) sum += mass(size.diameter);
  };
  double whole = 0.0, below = 0.0;
  for (const SizeCount& size : sizes) add(size, whole);
  for (const SizeCount& size : sizes) {
    add(size, below);
    if (below >= 0.5 * whole) return size.diameter;
  }
  return sizes.empty() ? 0.0 : sizes.back().diameter;
}

std::vector<std::size_t> shuffled_places(std::int64_t count, std::int64_t seed) {
  std::vector<std::pair<double, std::size_t>> order(static_cast<std::size_t>(count));  // random number, grain
  for (std::size_t grain = 0; grain < order.size(); ++grain)
    order[grain] = {uniform_random(static_cast<std::uint64_t>(seed), grain, size_draw), grain};
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> place(order.size());
  for (std::size_t p = 0; p < order.size(); ++p) place[order[p].second] = p;
  return place;
}

std::vector<double> sampled_diameters(const SizesKeys& sizes, std::int64_t count, std::int64_t seed, bool disks) {
  if (sizes.distribution) return lognormal_diameters(sizes, count, seed);
  const std::vector<double> by_place = sizes.sizes.empty()
                                           ? diameters_by_mass(mass_curve(sizes), count, disks ? 2.0 : 3.0)
                                           : listed_diameters(sizes, count);
  std::vector<double> diameters;
  for (const std::size_t place : shuffled_places(count, seed)) diameters.push_back(by_place[place]);
  return diameters;
}

}  // namespace thalweg::beds
