// The surfaces of solids as a time series for ParaView: one .vtp a frame, and an index that gives each its time.
#pragma once

#include "core/geometry/triangle_mesh.hpp"
#include "io/vtk/pvd_index.hpp"

#include <mpi.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace thalweg::io {

// Writes solids/solids_<step>.vtp in a folder, and solids.pvd: the triangles of all solids, in m, each with the number
// of its solid as the cell array `solid`. All calls are collective and throw RunError on every rank if a file cannot be
// written; the first rank writes.
class SolidSeries {
public:
  // continue_from: as for GrainSeries.
  SolidSeries(MPI_Comm communicator, const std::filesystem::path& folder,
              std::optional<double> continue_from = std::nullopt);

  // solids: in m, where they are at this time (s); looked at on the first rank.
  void write(double time, std::int64_t step, const std::vector<TriangleMesh>& solids);

  // True if there is no frame yet, here or from before. Collective.
  bool is_empty() const;

  // Makes the frames so far outlast a loss of power, as GrainSeries does.
  void put_on_disk() { index_.put_on_disk(); }

private:
  MPI_Comm communicator_;
  std::filesystem::path folder_;
  PvdIndex index_;
};

}  // namespace thalweg::io
