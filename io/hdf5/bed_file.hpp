// Bed files: the grains at the end of a run, from which another run can start.
//
// HDF5. Group `bed`: attributes format, time (s) and disk_thickness (m; 0: spheres), datasets box (m) and periodic (0
// or 1 along x, y, z). Group `grains`, one row a grain in order of id: id, radius, density, position, velocity,
// angular_velocity; where there are clumps, also clump: the id of the clump a member belongs to, -1 for others. Group
// `clumps`, one row a clump in order of id: id, volume (m^3), position of the centre (m), moments (m^5, about the
// principal axes, at 1 kg/m^3) and orientation (w, x, y, z, of these axes); a file without it has clumps that are the
// unions of their members. Members have the density of their clump. Every dataset has its labels (labelled_arrays.hpp).
// The bytes depend on the grains alone, not on the number of ranks.
#pragma once

#include "core/parallel/ranks.hpp"
#include "core/parallel/row_range.hpp"
#include "core/state/bed.hpp"
#include "core/state/snapshot.hpp"
#include "io/hdf5/hdf5_archive.hpp"

#include <mpi.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace thalweg::io {

// The density is the mass over the volume of the sphere or disk, or of the clump. Collective; throws RunError on every
// rank.
void write_bed_file(MPI_Comm communicator, const std::filesystem::path& path, const Snapshot& snapshot);

// The bed, with this rank's share of its grains: the ranks read it together. Throws InputError, on every rank, where
// the file is missing, damaged or not a bed file. Collective.
Bed read_bed_file(const std::filesystem::path& path, const Ranks& ranks = {});

// An even share of the rows of a bed, moved so that one rank has all members of a clump. clumps: the dataset with the
// clump of every row; where there is none, nothing is moved. file: opened by the ranks together. Collective.
RowRange share_of_bed(Hdf5Reader& file, const std::string& clumps, std::int64_t rows, const Ranks& ranks);

// A share of the rows of a dataset, `width` values each. Throws as Hdf5Reader::read(). Collective.
template <typename Number>
std::vector<Number> read_column(Hdf5Reader& file, const std::string& path, const RowRange& share,
                                std::uint64_t width = 1) {
  std::vector<Number> values(static_cast<std::size_t>(share.size()) * width);
  file.read(path, values, width == 1 ? share.box() : share.box(width));
  return values;
}

}  // namespace thalweg::io
