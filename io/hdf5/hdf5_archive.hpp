// HDF5 files behind core/base/archive.hpp: the checkpoints.
//
// The file's bytes depend on the data alone, not on the number of ranks that wrote it: every dataset is contiguous, of
// a little-endian type of fixed size, without time stamps, and all metadata are created collectively in the same order.
//
// Every dataset has an attribute "checksum" (checksum.hpp), and HDF5 itself keeps one of its metadata, so that a file
// in which a bit has changed is refused.
#pragma once

#include "core/base/archive.hpp"
#include "core/base/damaged_file.hpp"
#include "core/base/error.hpp"

#include <mpi.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::io {

// Data sets with one dimension that name dimensions of others, by their paths, as netCDF-4 does.
struct DimensionScales {
  struct Scale {
    std::string path;
    std::uint64_t length;
    bool is_coordinate;  // false: its values mean nothing
  };
  std::vector<Scale> scales;
  std::vector<std::pair<std::string, std::vector<std::string>>> of_arrays;  // of every dimension of an array, the scale
};

// Writes to `path` + ".partial" and gives the file its name in close(), so that the name never stands for half a file.
// Paths are "group/name"; an attribute "group/name" is kept on the group, and
// "group/dataset/name" on a dataset written before. All calls are collective over the
// communicator, and so are the errors: every call throws RunError on every rank if it failed on one (disk full, no
// permission).
class Hdf5Writer final : public ArchiveWriter {
public:
  Hdf5Writer(MPI_Comm communicator, const std::filesystem::path& path);
  ~Hdf5Writer() override;  // without close(): the unfinished file is thrown away
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  void write(const std::string& path, std::span<const double> values, const ArrayBox& box) override;
  void write(const std::string& path, std::span<const float> values, const ArrayBox& box) override;
  void write(const std::string& path, std::span<const std::int64_t> values, const ArrayBox& box) override;
  void attribute(const std::string& path, double value) override;
  void attribute(const std::string& path, std::int64_t value) override;
  void attribute(const std::string& path, const std::string& value) override;

  MPI_Comm communicator() const;

  // Names the dimensions of data sets that have been written. Once for a scale.
  void name_dimensions(const DimensionScales& scales);

  void close();  // writes what is left and gives the file its name

private:
  void give_up();  // not collective: throws the unfinished file away without closing it

  struct File;
  std::unique_ptr<File> file_;
};

// Reads what Hdf5Writer wrote, on any number of ranks. The constructor throws InputError if the file is missing or may
// not be read, and DamagedFile if it cannot be opened as HDF5. Reading throws InputError (naming file and path) where
// the path is missing or of another shape or type, and DamagedFile where the ranks have read a whole dataset, shared
// out or each all of it, and its checksum is another one; parts of a dataset are not checked. The constructor and
// read() are collective; any rank alone may call the rest. Without a communicator the file is read by this process
// alone, also where there is no MPI.
//
// shape() has at least one number, and the file has room for so many values: else it throws InputError or DamagedFile.
class Hdf5Reader final : public ArchiveReader {
public:
  explicit Hdf5Reader(const std::filesystem::path& path);
  Hdf5Reader(MPI_Comm communicator, const std::filesystem::path& path);
  ~Hdf5Reader() override;
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  // Treats data without a checksum as damaged from now on.
  void require_checksums();

  bool has(const std::string& path) const override;  // a dataset or an attribute
  std::vector<std::uint64_t> shape(const std::string& path) const override;
  void read(const std::string& path, std::span<double> values, const ArrayBox& box) override;
  void read(const std::string& path, std::span<float> values, const ArrayBox& box) override;
  void read(const std::string& path, std::span<std::int64_t> values, const ArrayBox& box) override;
  double real_attribute(const std::string& path) const override;
  std::int64_t integer_attribute(const std::string& path) const override;
  std::string text_attribute(const std::string& path) const override;

  // Contents of the file, sorted by path: for `thalweg info`.
  struct Entry {
    std::string path;
    std::string type;  // "float64", "float32" or "int64"
    std::vector<std::uint64_t> shape;
  };
  std::vector<Entry> datasets() const;

private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace thalweg::io
