// Provenance of a run: when and where it ran, with what it was built, and what it has read.
#pragma once

#include "driver/case/case.hpp"
#include "io/files/json_object.hpp"

#include <mpi.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::driver {

// A bed or a surface that a case names.
struct InputFile {
  std::string key, path;              // path: as in the case.yaml of the run folder
  std::optional<std::string> sha256;  // none: the file cannot be read, as of a run that goes on without it
};

struct Provenance {
  std::string started;          // of this session, UTC, ISO 8601
  std::string host, processor;  // of rank 0; empty where they are unknown
  std::int64_t nodes = 1;
  std::string compiler, flags, mpi, hdf5;
  std::vector<InputFile> inputs;  // on rank 0
};

// Rank 0 reads the files that the case names. folder: of the run; it exists. Collective.
Provenance provenance_of(const Case& c, const std::filesystem::path& folder, MPI_Comm communicator);

// As in summary.json.
io::JsonObject as_json(const Provenance& provenance);

// As in run.log.
std::vector<std::string> as_text(const Provenance& provenance);

}  // namespace thalweg::driver
