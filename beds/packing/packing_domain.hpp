// Packing domain: the part of the box in which each rank places grains at the start, and messages between ranks.
#pragma once

#include "core/geometry/periodic_box.hpp"
#include "core/parallel/decomposition.hpp"
#include "core/parallel/ranks.hpp"

#include <functional>
#include <utility>
#include <vector>

namespace thalweg::beds {

class PackingDomain : public Ranks {
public:
  // Domain of one process that places all grains of the box; no messages.
  explicit PackingDomain(const PeriodicBox& box) : box_(box) {}

  // Domains of the ranks of a decomposition, which must outlive this object. reach: m, distance up to which a rank
  // also knows the grains around its block, at least the largest distance of two centres that touch. box: the
  // decomposition's, whose size may differ from its cells times spacing by rounding.
  PackingDomain(const PeriodicBox& box, MPI_Comm communicator, const Decomposition& decomposition, double reach)
      : Ranks(decomposition.ranks() > 1 ? communicator : MPI_COMM_NULL),
        box_(box),
        decomposition_(&decomposition),
        reach_(reach) {}

  const PeriodicBox& box() const { return box_; }

  // Sets the places that random packings avoid: those with blocked(centre, radius) (m), the same on all ranks.
  void keep_clear_of(std::function<bool(const Vec3& centre, double radius)> blocked) { blocked_ = std::move(blocked); }
  bool blocked(const Vec3& centre, double radius) const { return blocked_ && blocked_(centre, radius); }

  // True if a point (m, wrapped) is in the block of this rank, and if it is within reach of it.
  bool owns(const Vec3& point) const { return alone() || decomposition_->owner_of(point) == number(); }
  bool knows(const Vec3& point) const { return alone() || decomposition_->reaches(number(), point, reach_); }

  // Each a collective exchange; returns what arrives here, in the order of the sending ranks. Rows are trivially
  // copyable and have a position: double[3], m, wrapped.
  template <typename Row>
  std::vector<Row> to_owners(std::vector<Row> rows) const {
    if (alone()) return rows;
    std::vector<int> homes;
    homes.reserve(rows.size());
    for (const Row& row : rows) homes.push_back(decomposition_->owner_of(Vec3(row.position)));
    return exchanged(std::move(rows), homes);
  }
  // Sends rows to all ranks that know their position.
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
    return exchanged(std::move(copies), homes);
  }

  // Gathers on every rank the rows that several ranks know, each once.
  template <typename Row>
  std::vector<Row> to_all(std::vector<Row> known) const {
    std::erase_if(known, [&](const Row& row) { return !owns(Vec3(row.position)); });
    return gathered(std::move(known));
  }

  // Requires several ranks.
  const Decomposition& decomposition() const { return *decomposition_; }

private:
  PeriodicBox box_;
  const Decomposition* decomposition_ = nullptr;
  double reach_ = 0.0;  // m
  std::function<bool(const Vec3&, double)> blocked_;
};

}  // namespace thalweg::beds
