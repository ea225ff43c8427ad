// A dataset that the first rank writes whole.
#pragma once

#include "core/base/archive.hpp"
#include "core/parallel/mpi_session.hpp"

#include <mpi.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace thalweg {

// values: of the whole dataset on the first rank; those of the others do not matter. shape: the same on every rank.
// Collective.
template <typename Number>
void write_whole(ArchiveWriter& archive, MPI_Comm communicator, const std::string& path, std::span<const Number> values,
                 const std::vector<std::uint64_t>& shape) {
  const std::vector<std::uint64_t> nothing(shape.size(), 0);
  const bool first = rank_of(communicator) == 0;
  archive.write(path, first ? values : values.first(0), {shape, nothing, first ? shape : nothing});
}

}  // namespace thalweg
