// `thalweg check`: what a case means, whether it is resolved and stable, and what it costs.
#pragma once

#include "driver/case/case.hpp"

#include <string>
#include <vector>

namespace thalweg::driver {

// Throws InputError where the grains do not fit or their step is too long for the contacts: what dem would refuse at
// the start of the run.
void refuse_impossible_grains(const Case& c);

// The whole report, one text a line. bandwidth: of one core's memory, bytes/s; 0: it does not bound the speed. Throws
// InputError where the case cannot be run (grains that do not fit, a grain step too long for the contacts).
std::vector<std::string> check_report(const Case& c, double bandwidth);

// The same for programs: a JSON object of the figures behind the lines, their units, the lines and the warnings.
std::string check_json(const Case& c, double bandwidth);

}  // namespace thalweg::driver
