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

// What is to be done with the folder. until: where the run is to end, s; a finished one that is to end later goes on.
// Where the folder has a run that is not finished, takes its lock, and then the request to stop (RunFolder::stop), if
// there is one: it came after the job before had ended, and means the chain. Throws InputError where another run has
// the lock, or the run can neither go on nor be replaced without a loss, as its checkpoints have been removed.
Resumption resumption_of(const io::RunFolder& folder, double until, io::FolderLock& lock);

}  // namespace thalweg::driver
