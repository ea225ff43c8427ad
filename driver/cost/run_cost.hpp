// Estimated cost of a run: work, memory, time on one core.
#pragma once

#include "analysis/observer/observer_memory.hpp"
#include "driver/case/case.hpp"

namespace thalweg::driver {

struct Cost {
  double cells;
  double steps;
  double cell_updates;
  double grain_steps;   // spheres, those of clumps among them, times sub-steps
  double core_seconds;  // one core
};
// bandwidth: bytes/s of one core's memory (machine.hpp); 0: it does not bound the speed.
Cost cost_of(const Case& c, double bandwidth);

// Memory, bytes.
double bytes_per_value(const Case& c);               // a population of a cell
double bytes_of_program();                           // a process before it has a system
double bytes_of_cell(const Case& c);                 // a cell of fluid
double bytes_of_lattice(const Case& c);              // the populations of all cells; 0 without a fluid
double bytes_of_grain(const Case& c, int ranks);     // a grain on one rank or several
double bytes_of_placing(const Case& c, int ranks);   // for what a rank knows of other grains while they are placed
double bytes_of_bed_rows(const Case& c, int ranks);  // a rank's share of the rows of bed files
double bytes_of_sizes(const Case& c);                // the different sizes, which every rank has
double bytes_of_links(const Case& c);                // the links of all grains

// What observers keep from one measurement to the next; while_saved: beyond what is counted of a grain while a frame is
// written.
analysis::ObserverMemory memory_of_observers(const Case& c);

// Number of links of a sphere so many cells wide, and of all grains of a case, clumps as the spheres of their volume; 0
// without a fluid.
double links_of_sphere(double cells_across);
double link_count(const Case& c);

}  // namespace thalweg::driver
