// A piece of a case that takes a core seconds and not hours: what `thalweg check --ranks` times.
#pragma once

#include "driver/case/case.hpp"

namespace thalweg::driver {

struct Sample {
  Case c;                  // along x shorter than the whole and periodic, nothing written, the fluid at rest
  double share;            // of the whole, 1
  double share_of_grains;  // 1: of those that the whole has in the mean of its run
};

// Sample of a case with grains, a fluid or both: the same faces across y and z, and as many grains per length as the
// whole has in the mean of its run, of one density and material. Grains that gravity holds down lie on the floor,
// touching, on a cubic lattice. Clumps become spheres of their volume; of mixed sizes only the largest touch. No grains
// come in or leave. Contacts are no stiffer than the step allows.
Sample sample_of(const Case& c);

}  // namespace thalweg::driver
