// A file that is given up while a library has it open and will still write to it.
#pragma once

#include <filesystem>

namespace thalweg::io {

// What this process writes from now on to the file, through any descriptor that it has open, goes to memory instead,
// and is lost. Where this is not possible, nothing changes.
void divert_to_memory(const std::filesystem::path& path);

}  // namespace thalweg::io
