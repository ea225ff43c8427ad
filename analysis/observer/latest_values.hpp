// The latest measurement of an observer that keeps nothing else: a run that goes on from its last step measures no
// more, and its summary has these values again.
#pragma once

#include "core/base/archive.hpp"
#include "core/state/system.hpp"

#include <string>
#include <vector>

namespace thalweg::analysis {

// Writes the values of diagnostics as NAME/latest_DIAGNOSTIC, or reads those that there are.
inline void save_latest(ArchiveWriter& archive, const std::string& name, const std::vector<Diagnostic>& diagnostics) {
  for (const Diagnostic& diagnostic : diagnostics)
    archive.attribute(name + "/latest_" + diagnostic.name, diagnostic.value);
}
inline void load_latest(ArchiveReader& archive, const std::string& name, std::vector<Diagnostic>& diagnostics) {
  for (Diagnostic& diagnostic : diagnostics)
    if (const std::string path = name + "/latest_" + diagnostic.name; archive.has(path))  // older checkpoints have none
      diagnostic.value = archive.real_attribute(path);
}

}  // namespace thalweg::analysis
