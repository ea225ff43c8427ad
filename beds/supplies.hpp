// Supplies and sinks as dem wants them, from their keys.
#pragma once

#include "beds/population/population.hpp"
#include "beds/population/supply_keys.hpp"
#include "dem/supply/supply.hpp"

#include <span>

namespace thalweg::beds {

// Throws KeyError where the population cannot be supplied, a region reaches out of a box of this size (m), or no grain
// can come in at its heights above the bed.
void check(const SupplyKeys& supply, std::span<const Population> populations, const Vec3& box_size);
void check(const SinkKeys& sink, const Vec3& box_size);

// The grains of a supply have the sizes of its population, each as often, in an order that is shuffled anew whenever
// all have come in. unit_rate: m^3/s, of a transport rate of 1.
dem::Supply supply_of(const SupplyKeys& keys, std::span<const Population> populations, const Vec3& box_size,
                      double unit_rate);
dem::Sink sink_of(const SinkKeys& keys, bool disks, const Vec3& box_size);

// kg/s of a supply of this population whose rate is no number of grains.
double mass_rate(const SupplyKeys& keys, const Population& population, double unit_rate);

// The mean mass of a grain or clump of a population, kg.
double mean_mass(const Population& population);

}  // namespace thalweg::beds
