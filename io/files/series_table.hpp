// series.csv: one row of numbers per time, under a header that names each column and its unit: time [s],q_star [1],...
#pragma once

#include <mpi.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace thalweg::io {

// Numbers are written with as many digits as it takes to read back the same bits. Rank 0 writes; all calls are
// collective and throw RunError on every rank if the file cannot be written.
class SeriesTable {
public:
  struct Column {
    std::string name;
    std::string unit;  // "1" for none
  };

  // columns: after the first, which is always time [s]. continue_from: take up an existing file and drop the rows after
  // that time (s), and a last row cut short; a file with other columns is an InputError. Empty: a new file.
  SeriesTable(MPI_Comm communicator, std::filesystem::path path, std::vector<Column> columns,
              std::optional<double> continue_from = std::nullopt);

  // Throws the InputError of the constructor, on every rank, before anything is written. Collective.
  static void check_columns(MPI_Comm communicator, const std::filesystem::path& path,
                            const std::vector<Column>& columns);

  // Appends a row, in the file before this returns. values: one per column; only rank 0's are used.
  void append(double time, std::span<const double> values);

  // The rows so far outlast a loss of power once this returns.
  void put_on_disk();

private:
  void throw_if_failed(bool failed) const;

  MPI_Comm communicator_;
  std::filesystem::path path_;
  std::vector<Column> columns_;
  std::ofstream file_;
};

}  // namespace thalweg::io
