// Everything a run writes into its folder while it goes on.
#pragma once

#include "analysis/observer.hpp"
#include "core/system.hpp"
#include "driver/accounts.hpp"
#include "driver/case.hpp"
#include "io/fluid_series.hpp"
#include "io/grain_series.hpp"
#include "io/record_file.hpp"
#include "io/run_folder.hpp"
#include "io/series_table.hpp"
#include "loop/time_loop.hpp"

#include <mpi.h>

#include <cstdint>
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
  // folder exists. continue_from: the simulated time (s) at which a restarted run takes up the folder's own series;
  // empty: new series. Everything referred to must outlive this.
  RunOutput(MPI_Comm communicator, const Case& c, const io::RunFolder& folder, const System& system,
            const Observers& observers, std::map<std::string, double> since, std::optional<double> continue_from);

  // Schedules and actions for the time loop; they refer to this object.
  void add_to(loop::LoopPlan& plan);

  // The table that rows with these figures go to. Throws InputError where the folder's has other columns. Collective.
  void begin_series(const std::vector<Figure>& row);

private:
  void add_grains(const std::filesystem::path& folder, const std::string& name, const io::GrainOutputKeys& keys,
                  const io::GrainSelectionKeys& selection);
  void add_fluid(const std::filesystem::path& folder, const std::string& name, const io::FluidOutputKeys& keys);
  void write_row(double time, const std::vector<Figure>& measured);
  std::uint64_t write_checkpoint(const loop::LoopRecord& record);  // bytes, on the first rank
  void write_profiles();
  void write_records();

  MPI_Comm communicator_;
  const Case& case_;
  const io::RunFolder& folder_;
  const System& system_;
  const Observers& observers_;
  std::map<std::string, double> since_;
  std::optional<double> continue_from_;
  std::vector<Figure> constants_;                           // of the run, in every row of the series
  std::unique_ptr<io::SeriesTable> series_;                 // from begin_series() on, if there is to be one
  std::vector<std::pair<double, io::GrainSeries>> grains_;  // each with the time between its frames, s
  std::vector<std::pair<double, io::FluidSeries>> fluid_;   // likewise
  std::vector<std::pair<analysis::Observer*, io::RecordFile>> records_;
};

// A checkpoint: what it is (group "run": format, system, name, version, step, time and time_step in s, spacing in m),
// the beds it began with, the system, the observers and the accounts. Its bytes do not depend on the number of ranks.
// Collective; RunError on every rank.
void write_checkpoint_file(MPI_Comm communicator, const std::filesystem::path& path, const Case& c,
                           const System& system, const Observers& observers, const Accounts& accounts);

// The state of a checkpoint into a system and observers built from a case. Throws InputError where they do not fit (in
// system, cells or time step), and io::DamagedFile.
Accounts read_checkpoint_file(MPI_Comm communicator, const std::filesystem::path& path, const Case& c, System& system,
                              Observers& observers);

// That of the first one which is not damaged; `damage`, a sentence about each before it, is added to. Returns its path.
std::filesystem::path read_first_whole_checkpoint(MPI_Comm communicator,
                                                  const std::vector<std::filesystem::path>& checkpoints, const Case& c,
                                                  System& system, Observers& observers,
                                                  std::vector<std::string>& damage, Accounts& accounts);

}  // namespace thalweg::driver
