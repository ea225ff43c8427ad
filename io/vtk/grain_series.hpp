// The grains as a time series for ParaView: one .vtp a frame, and an index that gives each its time.
#pragma once

#include "core/state/snapshot.hpp"
#include "io/vtk/grain_fields.hpp"
#include "io/vtk/grain_selection.hpp"
#include "io/vtk/pvd_index.hpp"

#include <mpi.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::io {

// Writes NAME/NAME_<step>.vtp in a folder, and NAME.pvd: a point a grain that is selected, ordered by id, with its
// radius (m) and the other fields as point arrays; stresses row by row (core/state/contact_stress.hpp). Where no fields
// are given, there are all that the snapshots have: clump and orientation only with clumps, fluid_force and
// fluid_stress only where there is a fluid. All ranks write one file together, and no rank gathers the grains. All
// calls are collective and throw RunError on every rank if a file cannot be written.
class GrainSeries {
public:
  // fields: empty: all there are. continue_from: simulated time (s) at which a restarted run takes up an existing
  // series; later frames are removed. Empty: a new series. facts: what frames have although no grain is there that has
  // it.
  GrainSeries(MPI_Comm communicator, const std::filesystem::path& folder, std::string name,
              GrainSelectionKeys selection, std::vector<GrainField> fields, PopulationIds population_ids,
              std::optional<double> continue_from = std::nullopt, const GrainFieldFacts& facts = {});

  void write(const Snapshot& snapshot);
  bool needs_grain_stress() const;  // whether frames have fluid_stress, which a step measures when asked

  // Makes the frames so far outlast a loss of power, before a checkpoint that counts on them.
  void put_on_disk() { index_.put_on_disk(); }

private:
  std::vector<NamedChoice<GrainField>> fields_in(const Snapshot& snapshot) const;

  MPI_Comm communicator_;
  std::filesystem::path folder_;
  std::string name_;
  GrainSelection selection_;
  std::vector<GrainField> fields_;
  PopulationIds population_ids_;
  GrainFieldFacts facts_;
  PvdIndex index_;
};

}  // namespace thalweg::io
