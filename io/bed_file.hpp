// Bed files: the grains of a run as its end left them, for another run to begin with.
//
// HDF5. Group `bed`: attributes format, time (s) and disk_thickness (m; 0: spheres), datasets box (m) and periodic (0
// or 1 along x, y, z). Group `grains`, one row a grain in order of id: id, radius, density, position, velocity,
// angular_velocity; where there are clumps, also clump: the id of the clump a member belongs to, -1 for others. A clump
// is the union of its members; their density is its own. Every dataset has its unit as attribute. The bytes depend on
// the grains alone, not on the number of ranks.
#pragma once

#include "core/bed.hpp"
#include "core/snapshot.hpp"

#include <mpi.h>

#include <filesystem>

namespace thalweg::io {

// The density is the mass over the volume of the sphere or disk, or of the clump. Collective; throws RunError on every
// rank.
void write_bed_file(MPI_Comm communicator, const std::filesystem::path& path, const Snapshot& snapshot);

// The whole bed, read by every rank that asks. Throws InputError where the file is missing or not a bed file.
Bed read_bed_file(const std::filesystem::path& path);

}  // namespace thalweg::io
