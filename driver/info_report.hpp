// `thalweg info`: what a run folder or a checkpoint holds.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace thalweg::driver {

// The report, one text a line. Throws InputError where the path is neither. Called by one rank.
std::vector<std::string> info_report(const std::filesystem::path& path);

}  // namespace thalweg::driver
