// Grains that come in during a run, as far as they can be known before it.
#pragma once

#include "driver/case/case.hpp"

#include <cstdint>

namespace thalweg::driver {

// m^3/s, of a transport rate q* of 1 over the width of the box; 0 where q* has no meaning.
double unit_rate(const Case& c);

// m/s, of the fastest grains that supplies and recirculations bring in by a velocity of their own; 0: there are none.
double fastest_supply(const Case& c);

// Grains/s of a supply, in the mean.
double grains_per_second(const Case& c, const beds::SupplyKeys& supply);

// Rows (grains, and members of clumps) that the box may hold at once: those of the start and all that are supplied, or,
// where there are sinks, at most twice those of the start.
std::int64_t most_rows(const Case& c);

// Rows in the box in the mean of the run over those at the start, to which supplies add evenly, as far as the box can
// hold them; 1 without any.
double mean_growth(const Case& c);

// Ids that have been given by the end of the run: those of the start and of all that are supplied, whether they have
// left or not.
double ids_of_run(const Case& c);

}  // namespace thalweg::driver
