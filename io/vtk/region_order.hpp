// Sends the cells of a region from the ranks that own them to the ranks that write them, in the order of the file (x
// fastest, z slowest). No rank holds more than its own part of either.
#pragma once

#include "core/parallel/decomposition.hpp"
#include "core/parallel/rows_by_id.hpp"

#include <mpi.h>

#include <cstdint>
#include <vector>

namespace thalweg::io {

class RegionOrder {
public:
  // parts: of the region, one a rank, empty or not; share: of its cells in the order of the file.
  RegionOrder(MPI_Comm communicator, std::vector<Block> parts, const Block& region, const BlockShare& share);

  // values: of the cells of this rank's part, x fastest, with all components of a cell together.
  // Returns those of this rank's share. Collective.
  std::vector<double> share_of(const std::vector<double>& values, int components) const;
  std::vector<float> share_of(const std::vector<float>& values, int components) const;
  std::vector<std::int32_t> share_of(const std::vector<std::int32_t>& values, int components) const;

private:
  template <typename Number>
  std::vector<Number> exchanged(const std::vector<Number>& values, int components, MPI_Datatype type) const;
  std::vector<int> cells_to_ranks() const;
  std::vector<int> cells_from_ranks() const;
  template <typename Visit>
  void for_each_row_from(int rank, Visit visit) const;

  MPI_Comm communicator_;
  std::vector<Block> parts_;
  Block region_;
  BlockShare share_;
  RowRange mine_;
  std::vector<int> sent_, received_;  // cells, to and from each rank; the same for every field
};

}  // namespace thalweg::io
