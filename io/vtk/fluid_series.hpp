// The fluid as a time series for ParaView: cell data of an image, and an index that gives each frame its time.
#pragma once

#include "core/state/snapshot.hpp"
#include "io/vtk/fluid_region.hpp"
#include "io/vtk/pvd_index.hpp"

#include <mpi.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::io {

using thalweg::FluidField;

enum class FieldPrecision { single, double_ };  // of the real numbers in a frame

// Writes NAME/NAME_<step>.vti in a folder, and NAME.pvd. The cell arrays have the names of FluidField and the units of
// FluidFields. All ranks write one file together; only the cells of the region are sampled, and no rank gathers them.
// All calls are collective and throw RunError on every rank if a file cannot be written.
class FluidSeries {
public:
  // continue_from: as for GrainSeries.
  FluidSeries(MPI_Comm communicator, const std::filesystem::path& folder, std::string name, FluidRegionKeys region,
              std::vector<FluidField> fields, FieldPrecision precision,
              std::optional<double> continue_from = std::nullopt);

  // Does nothing for a snapshot without a fluid.
  void write(const Snapshot& snapshot);

  // Makes the frames so far outlast a loss of power, before a checkpoint that counts on them.
  void put_on_disk() { index_.put_on_disk(); }

private:
  MPI_Comm communicator_;
  std::filesystem::path folder_;
  std::string name_;
  FluidRegionKeys region_;
  std::vector<FluidField> fields_;
  FieldPrecision precision_;
  PvdIndex index_;
};

}  // namespace thalweg::io
