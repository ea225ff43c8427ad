// Bed files: the grains of a run as its end left them, for another run to begin with.
//
// HDF5. Group `bed`: attributes format, time (s) and disk_thickness (m; 0: spheres), datasets box (m) and periodic (0
// or 1 along x, y, z). Group `grains`, one row a grain in order of id: id, radius, density, position, velocity,
// angular_velocity; where there are clumps, also clump: the id of the clump a member belongs to, -1 for others. A clump
// is the union of its members; their density is its own. Every dataset has its unit as attribute. The bytes depend on
// the grains alone, not on the number of ranks.
#pragma once

#include "core/snapshot.hpp"
#include "core/types.hpp"

#include <mpi.h>

#include <array>
#include <filesystem>
#include <vector>

namespace thalweg::io {

struct BedGrain {
  GlobalId id = 0;
  double radius = 0.0;                   // m
  double density = 0.0;                  // kg/m^3
  Vec3 position = Vec3::Zero();          // m
  Vec3 velocity = Vec3::Zero();          // m/s
  Vec3 angular_velocity = Vec3::Zero();  // rad/s
  GlobalId clump = -1;                   // id of the clump it is a member of; members follow each other
  bool operator==(const BedGrain&) const = default;
};

struct Bed {
  Vec3 box = Vec3::Zero();  // m
  std::array<bool, 3> periodic{};
  double time = 0.0;             // s, of the run that wrote it
  double disk_thickness = 0.0;   // m; 0: spheres
  std::vector<BedGrain> grains;  // in order of id
};

// The density is the mass over the volume of the sphere or disk, or of the clump. Collective; throws RunError on every
// rank.
void write_bed_file(MPI_Comm communicator, const std::filesystem::path& path, const Snapshot& snapshot);

// The whole bed, read by every rank that asks. Throws InputError where the file is missing or not a bed file.
Bed read_bed_file(const std::filesystem::path& path);

}  // namespace thalweg::io
