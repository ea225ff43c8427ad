#include "dem/distributed_argmax.hpp"

#include "core/parallel/mpi_session.hpp"

#include <tuple>

namespace thalweg::dem {

void DistributedArgmax::consider(const DistributedArgmax& candidate) {
  if (candidate.value > value ||
      (candidate.value == value && first >= 0 && std::tie(candidate.first, candidate.second) < std::tie(first, second)))
    *this = candidate;
}

std::optional<Location> DistributedArgmax::over_ranks(MPI_Comm communicator) const {
  const int ranks = size_of(communicator);
  struct Row {
    double value, position[3];
    GlobalId first, second;
  };
  const Row mine{value, {position[0], position[1], position[2]}, first, second};
  std::vector<Row> rows(static_cast<std::size_t>(ranks));
  MPI_Allgather(&mine, sizeof(Row), MPI_BYTE, rows.data(), sizeof(Row), MPI_BYTE, communicator);
  DistributedArgmax largest;
  for (const Row& row : rows)
    if (row.first >= 0)
      largest.consider({row.value, row.first, row.second, Vec3(row.position[0], row.position[1], row.position[2])});
  if (largest.first < 0) return std::nullopt;
  Location place{largest.position, {largest.first}};
  if (largest.second >= 0) place.grains.push_back(largest.second);
  return place;
}

}  // namespace thalweg::dem
