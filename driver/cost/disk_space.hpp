// Disk space that a run will need.
#pragma once

#include "driver/case/case.hpp"

#include <string>

namespace thalweg::driver {

// Bytes, at the end of the run. VTK files are compressed; what is estimated is without, the most they can take.
struct DiskSpace {
  double fluid, grains, solids;  // all frames
  double checkpoints;            // those kept, and the one being written
  double series;                 // series.csv
  double records;                // tracks, probes and the reach
  double total() const { return fluid + grains + solids + checkpoints + series + records; }
};
DiskSpace disk_space(const Case& c);

// About, of one.
double bytes_of_checkpoint(const Case& c);

// The line of the report; free: bytes free on the disk.
std::string disk_line(const DiskSpace& space, double free);

// "175 MB".
std::string bytes_text(double bytes);

}  // namespace thalweg::driver
