// The grains of a case, as dem wants them: the same for dry grains and for grains in a fluid.
#pragma once

#include "dem/grain_dynamics.hpp"
#include "driver/case.hpp"

#include <vector>

namespace thalweg::driver {

dem::PrescribedMotion prescribed_motion(const MotionCase& c);

// Contact law, time step, sub-steps, skin, rigid assemblies, and the walls: a plane with the walls' friction at every
// non-periodic face, in the order of the case's faces, then those of the section walls. The body force, ghost width and
// attached columns are left to the caller.
dem::GrainParameters grain_parameters(const Case& c, const PeriodicBox& box);

// All grains at the start, a clump with its centre at its place. Ids run through the populations in the order of the
// case. Given positions are taken first, then uniform patterns, then random ones, which keep clear of all others.
// Throws InputError where they do not fit. The same on every rank, without communication.
struct GrainSeeds {
  std::vector<dem::GrainSeed> grains;
  std::vector<dem::ClumpSeed> clumps;  // whose members have ids of their own
};
GrainSeeds grain_seeds(const Case& c);

}  // namespace thalweg::driver
