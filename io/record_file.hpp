// A file of what an observer has recorded so far, such as tracks.h5. It grows while the run goes on and is closed
// after each addition, so that it can be read in between.
//
// In the file: `fixed` as whole numbers, `rows` as arrays that get longer along their first dimension, each event a
// group with its figures and `time` as attributes (their units beside them: `time_unit`). Every array has the
// attributes `unit` and perhaps `components`.
#pragma once

#include "core/records.hpp"

#include <mpi.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace thalweg::io {

// Rank 0 writes, without MPI-IO. All calls are collective and throw RunError on every rank if the file cannot be
// written.
class RecordFile {
public:
  static constexpr const char* damaged_mark = ".damaged_";  // in the name of a file that has been moved

  // continue_from: take up an existing file and drop rows and events after that time (s); where its `fixed` numbers or
  // the shapes of its rows differ, the first add() throws InputError. One that is damaged, as by a kill, it moves to
  // tracks.damaged_1.h5 (the first number that is free) and begins anew. Empty: a new file.
  RecordFile(MPI_Comm communicator, std::filesystem::path path, std::optional<double> continue_from);

  // Throws what add() would, and changes nothing. records: they may have no rows yet.
  void check(const Records& records) const;

  void add(const Records& records);  // only rank 0's are used

  // On rank 0, after the first add(): that a damaged file has been moved, and where to; empty: none has.
  const std::string& warning() const { return warning_; }

  // What has been added outlasts a loss of power once this returns: before a checkpoint that counts on it.
  void put_on_disk();

private:
  void open_or_create(const Records& records);
  void write(const Records& records);                 // on rank 0
  void act(const std::function<void()>& work) const;  // on rank 0; what is wrong with the file, all ranks throw

  MPI_Comm communicator_;
  std::filesystem::path path_;
  std::optional<double> continue_from_;
  bool opened_ = false;
  std::string warning_;
};

}  // namespace thalweg::io
