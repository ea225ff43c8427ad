// Records of an observer, such as tracks: a folder of HDF5 files, each written once and never changed.
//
// A part, part_<step>.h5, holds what was added up to its step and is in no earlier part: the `fixed` numbers and
// `places`, `rows` as arrays whose first dimension is that of time, each event a group with its diagnostics and `time`
// as attributes (their units beside them: `time_units`). Every array has its labels (labelled_arrays.hpp). A part gets
// its name once it is on the disk, and before the checkpoint of its step is written: whenever a run ends, the parts up
// to a checkpoint are whole and hold all that lies before it, and the later ones, by their names, go at a restart.
#pragma once

#include "core/state/records.hpp"

#include <mpi.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

namespace thalweg::io {

// Rank 0 writes. All calls are collective and throw RunError on every rank if a part cannot be written.
class RecordParts {
public:
  // continue_from: the step of the checkpoint with which the run goes on in its folder; empty: a new folder. Changes
  // nothing yet.
  RecordParts(MPI_Comm communicator, std::filesystem::path folder, std::optional<std::int64_t> continue_from);

  // Writes what is not yet written, if possible: a run that fails shows how it came about.
  ~RecordParts();
  RecordParts(RecordParts&&) = default;
  RecordParts& operator=(RecordParts&&) = delete;

  // Throws InputError where there are parts with other `fixed` numbers, places or shapes of rows; records: they may
  // have no rows yet.
  void check(const Records& records) const;

  // Drops the parts after continue_from, or all; where none is left, writes a first one. The first of the calls that
  // write.
  void begin(const Records& records, std::int64_t step);

  // Keeps new rows and events, up to this step, until there is a part's worth of them. Only rank 0's are used.
  void add(const Records& records, std::int64_t step);

  // All that has been added is on the disk once this returns: before the checkpoint of `step`.
  void write(std::int64_t step);

private:
  std::filesystem::path part(std::int64_t step) const;
  void keep(const Records& records);
  bool has_kept() const { return kept_bytes_ > 0 && !(kept_.rows.empty() && kept_.events.empty()); }
  void write_part(std::int64_t step);  // on rank 0

  MPI_Comm communicator_;
  std::filesystem::path folder_;
  std::optional<std::int64_t> continue_from_;
  Records kept_;                // on rank 0: added and not written; `fixed` and `places` stay
  std::size_t kept_bytes_ = 0;  // of its numbers
  std::int64_t kept_until_ = 0;
};

// Removes the parts of a folder after `step`, and those that a kill has left unfinished. By one rank. Throws RunError.
void drop_parts_after(const std::filesystem::path& folder, std::int64_t step);

}  // namespace thalweg::io
