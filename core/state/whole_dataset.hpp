// Datasets that all ranks hold whole: the first rank writes, all read. And the shapes of what a checkpoint holds: a
// dataset that has lost rows is refused, and not taken for one of a run with other settings.
#pragma once

#include "core/base/archive.hpp"
#include "core/base/damaged_file.hpp"
#include "core/parallel/mpi_session.hpp"

#include <mpi.h>

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace thalweg {

// Writes a dataset. values: all of it on the first rank; the values of the others do not matter. shape: the same on
// every rank. Collective.
template <typename Number>
void write_whole(ArchiveWriter& archive, MPI_Comm communicator, const std::string& path, std::span<const Number> values,
                 const std::vector<std::uint64_t>& shape) {
  const std::vector<std::uint64_t> nothing(shape.size(), 0);
  const bool first = rank_of(communicator) == 0;
  archive.write(path, first ? values : values.first(0), {shape, nothing, first ? shape : nothing});
}

// The same with one dimension.
template <typename Number>
void write_whole(ArchiveWriter& archive, MPI_Comm communicator, const std::string& path,
                 const std::vector<Number>& values) {
  write_whole(archive, communicator, path, std::span<const Number>(values), {values.size()});
}

// All values of a dataset, on every rank. Throws as ArchiveReader::read() does. Collective.
template <typename Number>
std::vector<Number> read_whole(ArchiveReader& archive, const std::string& path) {
  const std::vector<std::uint64_t> shape = archive.shape(path);
  std::uint64_t size = 1;
  for (const std::uint64_t extent : shape) size *= extent;
  std::vector<Number> values(size);
  archive.read(path, std::span<Number>(values), {shape, std::vector<std::uint64_t>(shape.size(), 0), shape});
  return values;
}

// The failure of a dataset of which `what` is wrong, a clause.
DamagedFile damaged_dataset(const std::string& path, const std::string& what);

// Throws DamagedFile if a dataset has another shape than belongs to it.
void require_shape(const ArchiveReader& archive, const std::string& path, const std::vector<std::uint64_t>& shape);

// True if all of these datasets and attributes are there, false if none is. Throws DamagedFile if only some are.
bool has_all_or_none(const ArchiveReader& archive, std::initializer_list<std::string> paths);

// All values of a dataset of this shape, on every rank. Throws DamagedFile if it has another. Collective.
template <typename Number>
std::vector<Number> read_whole(ArchiveReader& archive, const std::string& path,
                               const std::vector<std::uint64_t>& shape) {
  require_shape(archive, path, shape);
  return read_whole<Number>(archive, path);
}

// The same for a dataset whose shape depends on settings of the case, and is never empty: nothing if it was written
// with other settings. It is read then, too, so that its checksum tells a damaged one, which throws DamagedFile.
// Collective.
template <typename Number>
std::optional<std::vector<Number>> read_whole_if_alike(ArchiveReader& archive, const std::string& path,
                                                       const std::vector<std::uint64_t>& shape) {
  std::vector<Number> values = read_whole<Number>(archive, path);
  if (values.empty()) require_shape(archive, path, shape);
  if (archive.shape(path) != shape) return std::nullopt;
  return values;
}

}  // namespace thalweg
