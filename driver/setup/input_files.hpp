// Files that a case reads: beds, surfaces, other runs.
#pragma once

#include "driver/case/case.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::driver {

// Keys and paths of the files of a case.
std::vector<std::pair<std::string, std::string>> inputs_by_key(const Case& c);

// A path relative to a folder that exists, so that both can be moved together. One that has nothing in common with the
// path of the folder but the root stays absolute.
std::string path_from(const std::filesystem::path& folder, const std::string& path);

// The case with such paths.
Case with_paths_from(const std::filesystem::path& folder, Case c);

}  // namespace thalweg::driver
