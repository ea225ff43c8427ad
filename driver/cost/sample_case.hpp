// A piece of a case that takes a core seconds and not hours: what `thalweg check --ranks` times.
#pragma once

#include "driver/case/case.hpp"

namespace thalweg::driver {

struct Sample {
  Case c;        // along x shorter than the whole and periodic, nothing written, the fluid at rest
  double share;  // of the whole, 1
};

// Of a case with grains or a fluid, or both. It has the faces of the case across y and z, and its grains, as many a
// length. Where gravity holds them down they lie on a cubic lattice on the floor, so closely that they touch. Clumps
// become spheres of their volume; of mixed sizes only the largest touch.
Sample sample_of(const Case& c);

}  // namespace thalweg::driver
