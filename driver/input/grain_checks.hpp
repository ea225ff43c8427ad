// The part of case_checks.hpp that is about grains.
#pragma once

#include "driver/case/case.hpp"
#include "io/text/yaml_document.hpp"

namespace thalweg::driver {

// Throws InputError if the grains do not fit into the box or into their regions.
void check_that_grains_fit(const Case& c, const io::YamlDocument& document);

// Plates, disks, clumps, materials and the steps a contact takes. Throws InputError.
void check_grains(const Case& c, const io::YamlDocument& document);

}  // namespace thalweg::driver
