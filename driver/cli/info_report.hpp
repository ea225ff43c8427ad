// `thalweg info`: what a run folder or a checkpoint holds.
#pragma once

#include "io/folder/run_folder.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace YAML {
class Node;
}

namespace thalweg::driver {

// The report, one text a line. Throws InputError where the path is neither. Called by one rank.
std::vector<std::string> info_report(const std::filesystem::path& path);

// The same as JSON: `path`; of a run folder `state`, `summary` (summary.json, null where there is none), `last_line` of
// its log and `checkpoint` (null where there is none): its `path`, `name`, `system`, `version`, `time` (s), `step`,
// `time_step` (s) and `datasets`. Of a checkpoint `path` and `checkpoint`. Throws as info_report().
std::string info_json(const std::filesystem::path& path);

// Throws InputError unless it is one.
void require_run_folder(const io::RunFolder& folder);

// State of a run without a summary: "running", "not running: ...", or both if the lock of its folder does not tell.
std::string state_without_summary(const io::RunFolder& folder);

// summary.json; null where there is none. Throws InputError where it is damaged.
YAML::Node summary_in(const io::RunFolder& folder);

// As above, but null if a crash has left a truncated file.
YAML::Node whole_summary_in(const io::RunFolder& folder);

}  // namespace thalweg::driver
