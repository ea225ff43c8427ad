// What a run needs, estimated from its case: work, memory, time on one core.
#pragma once

#include "driver/case.hpp"

namespace thalweg::driver {

struct Cost {
  double cells;
  double steps;
  double cell_updates;
  double grain_steps;   // grains times sub-steps
  double core_seconds;  // one core
};
// bandwidth: bytes/s of one core's memory (machine.hpp).
Cost cost_of(const Case& c, double bandwidth);

// Memory, bytes: of a number in the lattice, of a process before it has a system, of a cell of fluid, of a grain on one
// or several ranks, of what a rank knows of other grains while they are placed, of a rank's share of the rows of bed
// files, of the different sizes, which every rank has, and of the links of all grains.
double bytes_per_value(const Case& c);
double bytes_of_program();
double bytes_of_cell(const Case& c);
double bytes_of_grain(const Case& c, int ranks);
double bytes_of_placing(const Case& c, int ranks);
double bytes_of_bed_rows(const Case& c, int ranks);
double bytes_of_sizes(const Case& c);
double bytes_of_links(const Case& c);

// Links of a sphere so many cells wide.
double links_of_sphere(double cells_across);

}  // namespace thalweg::driver
