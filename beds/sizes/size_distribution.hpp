// Size distribution of the grains of a population.
#pragma once

#include "core/keys/section_visitor.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace thalweg::beds {

enum class SizeDistribution { lognormal };

// The share of the mass that passes each of a set of sieves; linear in ln d between them.
struct SieveKeys {
  std::vector<double> sizes;  // m, rising
  std::vector<double> finer;  // 1, of the mass, from 0 to 1; as many
  bool operator==(const SieveKeys&) const = default;
};

// Keys of a size distribution; nothing given: equal diameters.
struct SizesKeys {
  std::optional<SizeDistribution> distribution;
  std::optional<double> median;               // m, by number, before the tails are cut
  std::optional<double> geometric_deviation;  // 1; exp of the standard deviation of ln d
  std::optional<double> minimum, maximum;     // m, where the tails are cut, also those of d16 and d84
  std::vector<double> sizes;                  // m, in place of a distribution
  std::vector<double> fractions;              // of the number of grains, as many as sizes
  std::optional<SieveKeys> sieve;
  std::optional<double> d16, d50, d84;  // m, by mass (grading_curve.hpp)
  bool operator==(const SizesKeys&) const = default;

  bool given() const { return distribution || !sizes.empty() || sieve || d50; }
};

// The section `diameter`: a distribution, or the one diameter (m) of all.
void describe(SectionVisitor& visit, SizesKeys& sizes, double& diameter);

double sphere_volume(double diameter);  // m^3

// Number of grains with a diameter (m).
struct SizeCount {
  double diameter;
  std::int64_t count;
  bool operator==(const SizeCount&) const = default;
};

// Counts diameters (m) in any order: sizes ascending, each once. merged(): the same of several such lists in a row.
std::vector<SizeCount> counted(std::vector<double> diameters);
std::vector<SizeCount> merged(std::vector<SizeCount> sizes);

// The diameter that half of the mass of these grains is finer than; m. sizes: rising. disks: their mass grows as d^2.
double median_by_mass(std::span<const SizeCount> sizes, bool disks);

// Place (0 ... count - 1) of every grain among the random numbers of all.
std::vector<std::size_t> shuffled_places(std::int64_t count, std::int64_t seed);

// One diameter (m) for each grain. A grain's quantile is the place of its random number among those of the population,
// so that the population follows the distribution as closely as its number allows, and the seed only shuffles.
// fractions: each size gets its share of the number, rounded so that the sum is right. disks: their mass grows as d^2.
std::vector<double> sampled_diameters(const SizesKeys& sizes, std::int64_t count, std::int64_t seed, bool disks);

}  // namespace thalweg::beds
