// Grains as rows of plain values, for messages between ranks and for files.
#pragma once

#include "core/base/types.hpp"
#include "dem/motion/grain_store.hpp"

#include <mpi.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::dem {

// A vector as rows hold it.
inline std::array<double, 3> plain(const Vec3& v) { return {v[0], v[1], v[2]}; }

// Everything of a grain that the next sub-step depends on, except its contacts and attached columns.
struct GrainRow {
  enum Vector { position, velocity, angular_velocity, contact_force, contact_torque, load_force, load_torque, vectors };

  GlobalId id;
  std::int64_t motion, material;
  double radius, mass;
  std::array<std::array<double, 3>, vectors> value;
  GlobalId clump = -1;
  std::array<double, 3> offset{};
};

struct GrainBatch {
  std::vector<GrainRow> rows;
  std::vector<double> attached;  // attached_width values a row
};

// Copies of the owned grains, in their order.
GrainBatch owned_grains(const GrainStore& store);

// Copies of those owned grains whose mark (one for each) is not zero, in their order.
GrainBatch marked_grains(const GrainStore& store, std::span<const char> marks);

// Replaces all grains of the store by those of the batch; no ghosts. Rows must be sorted by id.
void replace_owned(GrainStore& store, const GrainBatch& batch);

// Takes the owned grains whose mark is not zero out of the store and puts the grains of the batch, sorted by id, in.
// The store's grains stay sorted by id; no ghosts.
void replace_marked(GrainStore& store, std::span<const char> marks, const GrainBatch& batch);

// attached_width: values a row.
void sort_by_id(GrainBatch& batch, int attached_width);

// Sends row i to rank destination[i]; returns what arrived here, sorted by id. Collective.
GrainBatch exchange_grains(MPI_Comm communicator, GrainBatch batch, const std::vector<int>& destination,
                           int attached_width);

// Moves the owned grains to their owners: only those that leave are sent. The store's grains stay sorted by id; no
// ghosts. owner: a rank for each owned grain. Collective.
void move_grains(MPI_Comm communicator, GrainStore& store, const std::vector<int>& owner);

}  // namespace thalweg::dem
