// Fills in what follows from the grains' sections but is not in the case file itself: grains from bed files, sizes of a
// distribution, figures of clumps.
#pragma once

#include "core/parallel/ranks.hpp"
#include "core/state/bed.hpp"
#include "driver/case/case.hpp"
#include "io/text/yaml_document.hpp"

#include <functional>
#include <optional>

namespace thalweg::driver {

// The bed that the population of this number began with, with this rank's share of its rows, where that is known from
// elsewhere than its file; else none. Collective.
using KnownBeds = std::function<std::optional<Bed>(const Case&, std::size_t population, const Ranks&)>;

// Takes the bed of every population placed by a file, known already or from this file, and makes its path absolute;
// draws the sizes of every population with a distribution. Throws InputError, on every rank, with the place in the case
// file where a bed file is missing or no bed file, was made in a periodic box of another size, or holds grains outside
// the box or overlapping too much. Collective.
void fill_in_grains(Case& c, const io::YamlDocument& document, const KnownBeds& known, const Ranks& ranks);

}  // namespace thalweg::driver
