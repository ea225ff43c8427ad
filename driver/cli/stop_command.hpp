// `thalweg stop`: asks a run to save its state and end, without knowing where it runs.
#pragma once

#include <filesystem>
#include <string>

namespace thalweg::driver {

// Leaves the file `stop` in a run folder, which the run looks for several times a second; where none is going, the next
// one with --resume, as of a job that waits in a queue, finds it and ends. Nothing where the run is finished or has
// been stopped so before. Returns what to say about it. Throws InputError if this is no run folder.
std::string ask_to_stop(const std::filesystem::path& folder);

}  // namespace thalweg::driver
