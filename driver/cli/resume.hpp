// `thalweg run --resume`: begins a run or goes on with it, whatever its folder holds, so that a job script need not
// look.
#pragma once

#include "io/folder/folder_lock.hpp"
#include "io/folder/run_folder.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace thalweg::driver {

enum class Resumption {
  begin,        // there is no run
  begin_again,  // one was killed before its first checkpoint, or failed: there is nothing to lose
  go_on,        // from a checkpoint
  finished,     // nothing is left to do, and nothing is touched
  asked_to_stop
};

// run.until of a case with the given settings (case_reader.hpp), s; infinity where it is missing or not a number, which
// reading the case will tell. Throws InputError where the file is not a case at all.
double wanted_end(const std::filesystem::path& case_file, const std::vector<std::string>& settings);

// Decides how to continue the run in the folder. until: end of the run, s; a finished run with a later end continues.
// Takes the lock of an unfinished run, then its request to stop (RunFolder::stop), if any: this arrived between two
// jobs and ends the chain of jobs. Throws InputError if another run holds the lock, or if the run can neither continue
// nor be replaced without loss, because its checkpoints have been removed or it went on from another run.
Resumption resumption_of(const io::RunFolder& folder, double until, io::FolderLock& lock);

}  // namespace thalweg::driver
