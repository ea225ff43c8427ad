// The latest measurement of an observer that keeps nothing else: a run that goes on from its last step measures no
// more, and its summary has these values again.
#pragma once

#include "core/base/archive.hpp"
#include "core/state/system.hpp"
#include "core/state/whole_dataset.hpp"

#include <mpi.h>

#include <cstddef>
#include <string>
#include <vector>

namespace thalweg::analysis {

// Writes the values of diagnostics as NAME/latest, or reads them if there are as many. Collective.
inline void save_latest(ArchiveWriter& archive, MPI_Comm communicator, const std::string& name,
                        const std::vector<Diagnostic>& diagnostics) {
  std::vector<double> values;
  for (const Diagnostic& diagnostic : diagnostics) values.push_back(diagnostic.value);
  write_whole(archive, communicator, name + "/latest", values);
}
inline void load_latest(ArchiveReader& archive, const std::string& name, std::vector<Diagnostic>& diagnostics) {
  const std::string path = name + "/latest";
  if (!archive.has(path)) return;  // older checkpoints have none
  const auto values = read_whole_if_alike<double>(archive, path, {diagnostics.size()});
  for (std::size_t n = 0; values && n < values->size(); ++n) diagnostics[n].value = (*values)[n];
}

}  // namespace thalweg::analysis
