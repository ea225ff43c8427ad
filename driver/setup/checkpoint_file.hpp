// The file from which a run goes on.
#pragma once

#include "analysis/observer/observer.hpp"
#include "core/state/system.hpp"
#include "driver/case/case.hpp"
#include "driver/setup/run_history.hpp"
#include "io/hdf5/hdf5_archive.hpp"

#include <mpi.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace thalweg::driver {

// A checkpoint: what it is (group "run": format, system, name, version, step, time and time_step in s, spacing and, of
// grains, the periods of the box in m),
// the keys of the case that a restart may not change (group "kept_case", case_changes.hpp), the beds it began with, the
// system, the observers and the run_history. Its bytes do not depend on the number of ranks. kept_case:
// kept_case_of(c). Collective; RunError on every rank.
void write_checkpoint_file(MPI_Comm communicator, const std::filesystem::path& path, const Case& c,
                           const std::string& kept_case, const System& system, const Observers& observers,
                           const RunHistory& run_history);

// Name of the attribute with the period (m) of the box of the grains along an axis, 0 where it is not periodic.
// (Checkpoints of earlier versions have none.)
std::string saved_period(std::size_t axis);

// Lets a checkpoint be read only where its data have the checksums that it was written with. (Those from before the
// formats had numbers may have none.)
void require_checksums(io::Hdf5Reader& checkpoint);

// These keys and their values. As slow as writing the case.
std::string kept_case_of(const Case& c);

// The state of a checkpoint into a system and observers built from a case. Throws InputError where they do not fit (in
// system, cells, time step or one of the kept keys), and DamagedFile.
RunHistory read_checkpoint_file(MPI_Comm communicator, const std::filesystem::path& path, const Case& c, System& system,
                                Observers& observers);

// Reads the first undamaged checkpoint and returns its path; appends a sentence about each damaged one to `damage`. A
// damaged one may have been read in part: after it, `observers` are made anew.
std::filesystem::path read_first_whole_checkpoint(MPI_Comm communicator,
                                                  const std::vector<std::filesystem::path>& checkpoints, const Case& c,
                                                  System& system, Observers& observers,
                                                  const std::function<Observers()>& new_observers,
                                                  std::vector<std::string>& damage, RunHistory& run_history);

}  // namespace thalweg::driver
