#include "driver/bed/supplied_grains.hpp"

#include "beds/packing/packing.hpp"
#include "beds/supplies.hpp"
#include "driver/bed/reference_grain.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::driver {

double unit_rate(const Case& c) {
  if (!has_fluid(c) || c.grains.empty()) return 0.0;
  const ReferenceGrain grain = reference_grain(c);
  const double weight = std::abs(grain.density / c.fluid.density - 1.0) * gravity_vector(c.gravity).norm();
  return std::sqrt(weight * grain.diameter) * grain.diameter * c.domain.size.y();
}

double fastest_supply(const Case& c) {
  double fastest = 0.0;
  for (const beds::SupplyKeys& supply : c.supplies)
    if (supply.velocity) fastest = std::max(fastest, supply.velocity->norm());
  for (const beds::SinkKeys& sink : c.sinks)
    if (sink.recirculation && sink.recirculation->velocity)
      fastest = std::max(fastest, sink.recirculation->velocity->norm());
  return fastest;
}

double grains_per_second(const Case& c, const beds::SupplyKeys& supply) {
  if (supply.rate) return *supply.rate;
  const beds::Population& population = c.grains[static_cast<std::size_t>(supply.population)];
  return beds::mass_rate(supply, population, unit_rate(c)) / beds::mean_mass(population);
}

namespace {

// Ids that each of its grains takes: of a clump its members.
double ids_each(const Case& c, const beds::SupplyKeys& supply) {
  const beds::Population& population = c.grains[static_cast<std::size_t>(supply.population)];
  return population.shape ? static_cast<double>(population.shape->clump.size()) : 1.0;
}

// All grains of a supply.
double grains_of(const Case& c, const beds::SupplyKeys& supply) {
  const double until = std::min(c.run.until, supply.until.value_or(c.run.until));
  return grains_per_second(c, supply) * std::max(0.0, until - supply.from);
}

}  // namespace

std::int64_t most_rows(const Case& c) {
  const std::int64_t at_start = grain_rows(c);
  double supplied = 0.0;
  for (const beds::SupplyKeys& supply : c.supplies) supplied += ids_each(c, supply) * grains_of(c, supply);
  if (!c.sinks.empty()) supplied = std::min(supplied, static_cast<double>(at_start));
  return at_start + static_cast<std::int64_t>(std::min(supplied, 1e15));
}

double mean_growth(const Case& c) {
  const double rows = static_cast<double>(grain_rows(c)), most = static_cast<double>(most_rows(c));
  if (rows == 0.0) return 1.0;
  const double fit = c.disks ? most : rows * beds::densest_bed * c.domain.size.prod() / grain_volume(c);
  return 0.5 * (rows + std::min(most, std::max(rows, fit))) / rows;
}

double ids_of_run(const Case& c) {
  double rounds = 0.0, a_round = 0.0;  // each has ids for one grain of every supply (dem/supply/turnover.hpp)
  for (const beds::SupplyKeys& supply : c.supplies) {
    rounds = std::max(rounds, grains_of(c, supply));
    a_round += ids_each(c, supply);
  }
  return static_cast<double>(grain_rows(c)) + rounds * a_round;
}

}  // namespace thalweg::driver
