// Fills in what follows from the grains' sections but is not in the case file itself: grains from bed files, sizes of a
// distribution, figures of clumps.
#pragma once

#include "driver/case.hpp"
#include "io/yaml_document.hpp"

namespace thalweg::driver {

// Reads the bed file of every population placed by one and makes its path absolute; draws the sizes of every
// population with a distribution. Throws InputError with the place in the case file where a bed file is missing or no
// bed file, was made in a periodic box of another size, or holds grains outside the box or overlapping too much.
void fill_in_grains(Case& c, const io::YamlDocument& document);

}  // namespace thalweg::driver
