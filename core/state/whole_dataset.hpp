// Datasets that all ranks hold whole: the first rank writes, all read.
#pragma once

#include "core/base/archive.hpp"
#include "core/parallel/mpi_session.hpp"

#include <mpi.h>

#include <cstdint>
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

}  // namespace thalweg
