// series.csv: one row of numbers per time, under a header that names each column and its unit: time [s],q_star [1],...
#pragma once

#include "io/files/series_columns.hpp"

#include <mpi.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>

namespace thalweg::io {

// Numbers are written with as many digits as it takes to read back the same bits. Rank 0 writes; all calls are
// collective and throw RunError on every rank if the file cannot be written.
class SeriesTable {
public:
  // continue_from: time (s) up to which an existing file is kept; later rows and a last row cut short are dropped, and
  // a file with other columns is an InputError. Empty: a new file.
  SeriesTable(MPI_Comm communicator, std::filesystem::path path, SeriesColumns columns,
              std::optional<double> continue_from = std::nullopt);

  // Throws the InputError of the constructor, on every rank, before anything is written. Collective.
  static void check_columns(MPI_Comm communicator, const std::filesystem::path& path, const SeriesColumns& columns);

  // Drops the rows of a file, if there is one, after a time (s): those of a run that no longer writes them. Collective.
  static void drop_rows_after(MPI_Comm communicator, const std::filesystem::path& path, double time);

  // Appends a row, which is in the file when this returns; only rank 0's values are used. Throws std::logic_error, on
  // every rank, if the row has other columns.
  void append(double time, std::span<const Diagnostic> row);

  // A sentence if rows of the file that is continued are missing before the time from which it is; empty elsewhere.
  const std::string& gap() const { return gap_; }

  // Makes the rows so far outlast a loss of power.
  void put_on_disk();

private:
  void throw_if_failed(bool failed) const;

  MPI_Comm communicator_;
  std::filesystem::path path_;
  SeriesColumns columns_;
  std::string gap_;  // on the first rank
  std::ofstream file_;
};

}  // namespace thalweg::io
