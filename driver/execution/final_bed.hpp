// The bed that a run leaves behind, whether or not analysis.bed_surface has followed it.
#pragma once

#include "core/state/system.hpp"
#include "driver/case/case.hpp"

#include <mpi.h>

#include <string>
#include <vector>

namespace thalweg::driver {

// Bed of the present state, as analysis.bed_surface measures it: bed_height (m), porosity (1, of the lower half of the
// bed), and under a fluid flow_depth and hydraulic_radius (m) and, in a driven flow, bed_stress (Pa) and
// shields_number (none beside solids); only the first two if the grains are too loose to be a bed. Empty without
// grains, and if z is periodic. Collective; the same on every rank.
std::vector<Diagnostic> final_bed(MPI_Comm communicator, const Case& c, const System& system);

// One line of text; empty for an empty list.
std::string final_bed_text(const std::vector<Diagnostic>& bed);

}  // namespace thalweg::driver
