// Lines of `thalweg check` about the fluid, the flow and the bed.
#pragma once

#include "driver/case/case.hpp"

#include <string>
#include <vector>

namespace thalweg::driver {

// One text a line; none without a fluid.
std::vector<std::string> fluid_lines(const Case& c);

// tau* that the lines below give: of the hydraulic radius and the slope, or of the flow that drives in its place. Not a
// number where there is none.
double expected_shields_number(const Case& c);

// Reference grain, density ratio, bed, Shields number, times and stresses, as far as the case has them; none without
// grains in a fluid but for the slope of dry grains.
std::vector<std::string> bed_lines(const Case& c);

}  // namespace thalweg::driver
