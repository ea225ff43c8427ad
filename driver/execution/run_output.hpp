// Everything a run writes into its folder while it goes on.
#pragma once

#include "analysis/observer/observer.hpp"
#include "core/state/system.hpp"
#include "driver/case/case.hpp"
#include "driver/setup/run_history.hpp"
#include "io/files/series_table.hpp"
#include "io/folder/run_folder.hpp"
#include "io/hdf5/record_parts.hpp"
#include "io/vtk/fluid_series.hpp"
#include "io/vtk/grain_series.hpp"
#include "io/vtk/solid_series.hpp"
#include "loop/time_loop.hpp"

#include <mpi.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::driver {

class RunOutput {
public:
  // row: what a row of the series has. continue_from: the simulated time (s) at which a restarted run takes up the
  // folder's own series; empty: new series. Throws InputError where the folder has series or records of another kind,
  // and changes nothing. Everything referred to must outlive this.
  RunOutput(MPI_Comm communicator, const Case& c, const io::RunFolder& folder, const System& system,
            const Observers& observers, const std::vector<Diagnostic>& row, std::map<std::string, double> since,
            std::optional<double> continue_from);

  // Begins the files, or takes them up: what is later than the state the run goes on from is removed. Collective; the
  // first of all calls. Returns, on the first rank, a sentence about what is missing of them; empty: nothing.
  std::string begin();

  // Schedules and actions for the time loop; they refer to this object.
  void add_to(loop::LoopPlan& plan);

private:
  void add_grains(const std::filesystem::path& folder, const std::string& name, const io::GrainOutputKeys& keys,
                  const io::GrainSelectionKeys& selection);
  void add_fluid(const std::filesystem::path& folder, const std::string& name, const io::FluidOutputKeys& keys);
  void begin_solids();
  void write_solids(double time, std::int64_t step);
  void write_row(double time, const std::vector<Diagnostic>& measured);
  std::uint64_t write_checkpoint(const loop::LoopRecord& record);  // bytes, on the first rank
  void write_profiles();
  void add_records();
  void put_on_disk();
  void drop_what_is_later() const;

  MPI_Comm communicator_;
  const Case& case_;
  const io::RunFolder& folder_;
  const System& system_;
  const Observers& observers_;
  std::map<std::string, double> since_;
  std::optional<double> continue_from_;                     // the time of the system's state, s
  std::string kept_case_;                                   // for checkpoints
  std::vector<Diagnostic> constants_;                       // of the run, in every row of the series
  io::SeriesColumns columns_;                               // of the series
  std::unique_ptr<io::SeriesTable> series_;                 // from begin() on, if there is to be one
  std::vector<std::pair<double, io::GrainSeries>> grains_;  // each with the time between its frames, s
  std::vector<std::pair<double, io::FluidSeries>> fluid_;   // the same for the fluid
  std::optional<io::SolidSeries> solids_;                   // where there are frames of grains or fluid
  std::optional<std::int64_t> solids_step_;                 // of its latest frame in this session
  struct ObserverRecords {
    analysis::Observer* observer;
    io::RecordParts parts;
    Records first;  // until begin() writes them
  };
  std::vector<ObserverRecords> records_;
};

}  // namespace thalweg::driver
