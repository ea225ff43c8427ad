// Settings that the sums of an observer depend on, saved with them.
#pragma once

#include "core/archive.hpp"

#include <string>

namespace thalweg::analysis {

// Whether the archive's sums were made with this value. Archives from before it was saved do not say, and are taken.
inline bool was_saved_with(const ArchiveReader& archive, const std::string& path, double value) {
  return !archive.has(path) || archive.real_attribute(path) == value;
}

}  // namespace thalweg::analysis
