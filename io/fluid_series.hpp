// The fluid as a time series for ParaView: cell data of an image, and fluid.pvd that gives each frame its time.
#pragma once

#include "core/snapshot.hpp"
#include "io/pvd_index.hpp"

#include <mpi.h>

#include <filesystem>
#include <optional>
#include <vector>

namespace thalweg::io {

enum class FluidRegion { whole, slice_x, slice_y, slice_z };  // a slice: the middle layer of cells across that axis
using thalweg::FluidField;

// Writes fluid/fluid_<step>.vti in the run folder. The cell arrays have the names of FluidField and the units of
// FluidFields. All ranks write one file together; only the cells of the region are sampled, and no rank gathers them.
// All calls are collective and throw RunError on every rank if a file cannot be written.
class FluidSeries {
public:
  // continue_from: as for GrainSeries.
  FluidSeries(MPI_Comm communicator, const std::filesystem::path& run_folder, FluidRegion region,
              std::vector<FluidField> fields, std::optional<double> continue_from = std::nullopt);

  // Does nothing for a snapshot without a fluid.
  void write(const Snapshot& snapshot);

private:
  MPI_Comm communicator_;
  std::filesystem::path folder_;
  FluidRegion region_;
  std::vector<FluidField> fields_;
  PvdIndex index_;
};

}  // namespace thalweg::io
