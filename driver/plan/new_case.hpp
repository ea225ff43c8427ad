// `thalweg new`: a complete case from what an experimenter knows. Spacing, step, contacts, start, duration and
// averaging window are solved for together, until check has no warning.
#pragma once

#include "driver/plan/experiment.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace thalweg::driver {

// Writes the case and returns what to say of it: its size and cost, what follows from the flow, what the accuracy
// leaves. Throws InputError, and leaves no file, where the experiment is refused (experiment.hpp), cannot be (a bed
// that would slide), or takes more than the hours at hand even in the smallest box; and where the file exists.
// bandwidth: bytes/s of one core's memory.
std::vector<std::string> write_new_case(const Experiment& experiment, const std::filesystem::path& path,
                                        double bandwidth);

}  // namespace thalweg::driver
