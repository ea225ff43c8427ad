// The section flow: the slope, or the height of the box, or both, from a Shields number and a depth over the bed that
// the grains make.
//
//   tau* = g sin(alpha) R / ((s - 1) g d)       R = H, or H W/(n H + W) beside n side walls (estimate/bed_flow.hpp)
//   size z = height of the settled bed + H      rounded to whole cells
#pragma once

#include "core/parallel/ranks.hpp"
#include "driver/input/bed_placement.hpp"
#include "io/text/yaml_document.hpp"

namespace thalweg::driver {

// Adds the keys that follow to a document that has the section; text of what is filled in: "gravity.slope: 0.0453, for
// ...". Throws InputError, with file and line, where the section does not determine exactly one flow, or asks for one
// that does not exist. Collective.
FlowFilledIn derive_flow(io::YamlDocument& document, const KnownBeds& known, const Ranks& ranks);

}  // namespace thalweg::driver
