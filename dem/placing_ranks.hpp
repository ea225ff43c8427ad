// Ranks that place grains together at the start: which part of the box each one answers for, and messages between them.
#pragma once

#include "core/decomposition.hpp"
#include "core/mpi_session.hpp"
#include "core/periodic_box.hpp"
#include "core/row_range.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace thalweg::dem {

class PlacingRanks {
public:
  // One process that places all grains of the box; no messages.
  explicit PlacingRanks(const PeriodicBox& box) : box_(box) {}

  // The ranks of a decomposition. reach: m, to which each also knows the grains around its block; at least the largest
  // distance of two centres that touch. The decomposition is to live as long. box: the decomposition's, whose size may
  // differ from its cells times spacing by rounding.
  PlacingRanks(const PeriodicBox& box, MPI_Comm communicator, const Decomposition& decomposition, double reach)
      : box_(box),
        communicator_(communicator),
        decomposition_(decomposition.ranks() > 1 ? &decomposition : nullptr),
        reach_(reach) {}

  const PeriodicBox& box() const { return box_; }
  bool alone() const { return !decomposition_; }

  // Of things numbered from 0 on, those with which this rank begins.
  RowRange share_of(std::int64_t count) const {
    return alone() ? RowRange(count, 1, 0) : RowRange(count, size_of(communicator_), rank_of(communicator_));
  }

  // Of a point (m, wrapped): whether it is in the block of this rank, and whether it is within reach of it.
  bool owns(const Vec3& point) const { return alone() || decomposition_->owner_of(point) == rank_of(communicator_); }
  bool knows(const Vec3& point) const {
    return alone() || decomposition_->reaches(rank_of(communicator_), point, reach_);
  }

  // Each a collective exchange; returns what arrives here, in the order of the sending ranks. Rows are trivially
  // copyable and have a position: double[3], m, wrapped.
  template <typename Row>
  std::vector<Row> to_owners(std::vector<Row> rows) const {
    if (alone()) return rows;
    std::vector<int> homes;
    homes.reserve(rows.size());
    for (const Row& row : rows) homes.push_back(decomposition_->owner_of(Vec3(row.position)));
    return exchange_rows(communicator_, std::move(rows), homes);
  }
  // To all ranks that know the place.
  template <typename Row>
  std::vector<Row> to_knowing(const std::vector<Row>& rows) const {
    if (alone()) return rows;
    std::vector<Row> copies;
    std::vector<int> homes;
    for (const Row& row : rows)
      for (const int rank : decomposition_->ranks_reached(Vec3(row.position), reach_)) {
        copies.push_back(row);
        homes.push_back(rank);
      }
    return exchange_rows(communicator_, std::move(copies), homes);
  }
  template <typename Row>
  std::vector<Row> to_all(const std::vector<Row>& rows) const {
    if (alone()) return rows;
    std::vector<Row> copies;
    std::vector<int> homes;
    for (int rank = 0; rank < size_of(communicator_); ++rank) {
      copies.insert(copies.end(), rows.begin(), rows.end());
      homes.insert(homes.end(), rows.size(), rank);
    }
    return exchange_rows(communicator_, std::move(copies), homes);
  }

  // Over all ranks. Collective.
  std::int64_t sum(std::int64_t value) const { return alone() ? value : sum_over_ranks(communicator_, value); }
  double largest(double value) const { return alone() ? value : max_over_ranks(communicator_, value); }

  // Of ranks that are not alone.
  const Decomposition& decomposition() const { return *decomposition_; }
  MPI_Comm communicator() const { return communicator_; }

private:
  PeriodicBox box_;
  MPI_Comm communicator_ = MPI_COMM_NULL;
  const Decomposition* decomposition_ = nullptr;  // null: alone
  double reach_ = 0.0;                            // m
};

}  // namespace thalweg::dem
