// What comes into the box of a case and leaves it, as dem wants it.
#pragma once

#include "core/geometry/periodic_box.hpp"
#include "dem/grain_dynamics.hpp"
#include "driver/case/case.hpp"

namespace thalweg::driver {

// Adds the supplies and sinks of a case to the parameters of its grains. box: theirs.
void add_turnover(const Case& c, const PeriodicBox& box, dem::GrainParameters& parameters);

}  // namespace thalweg::driver
