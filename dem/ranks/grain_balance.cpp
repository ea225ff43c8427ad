#include "dem/ranks/grain_balance.hpp"

#include "core/parallel/mpi_session.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace thalweg::dem {

std::optional<Decomposition> balanced_cuts(const Decomposition& decomposition, const GrainStore& store,
                                           MPI_Comm communicator) {
  constexpr double tolerated = 1.1;
  const double mine = static_cast<double>(store.owned);
  const std::int64_t all = sum_over_ranks(communicator, static_cast<std::int64_t>(store.owned));
  const double mean = static_cast<double>(all) / decomposition.ranks();
  if (max_over_ranks(communicator, mine) <= tolerated * mean) return {};

  const Index3& cells = decomposition.cells();
  std::vector<std::int64_t> counts(static_cast<std::size_t>(cells[0]) + cells[1] + cells[2], 0);
  const std::array<std::size_t, 3> first{0, static_cast<std::size_t>(cells[0]),
                                         static_cast<std::size_t>(cells[0]) + cells[1]};
  for (std::size_t s = 0; s < store.owned; ++s)
    for (int a = 0; a < 3; ++a) {
      const int cell = static_cast<int>(std::floor(store.position[s][a] / decomposition.spacing()));
      ++counts[first[a] + std::clamp(cell, 0, cells[a] - 1)];
    }
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), static_cast<int>(counts.size()), MPI_INT64_T, MPI_SUM, communicator);
  std::array<std::vector<std::int64_t>, 3> weights;
  for (int a = 0; a < 3; ++a) {
    const auto begin = counts.begin() + static_cast<std::ptrdiff_t>(first[a]);
    weights[a].assign(begin, begin + cells[a]);
  }
  const Decomposition moved = decomposition.balanced(weights);
  if (moved == decomposition) return {};
  return moved;
}

}  // namespace thalweg::dem
