// Which of a rank's grains are ghosts elsewhere, and the one packed message a neighbour that keeps them up to date.
#pragma once

#include "core/decomposition.hpp"
#include "core/packed_exchange.hpp"
#include "dem/grain_store.hpp"
#include "dem/moving_grains.hpp"

#include <mpi.h>

#include <cstdint>
#include <vector>

namespace thalweg::dem {

class GhostExchange {
public:
  // Every grain becomes a ghost of every other rank whose block, or one of whose grains, may be within `reach` (m) of
  // it, once a rank. overhang: m, how far grains may be outside the block of the rank that owns them, because the
  // centre of their clump is inside.
  GhostExchange(const Decomposition& decomposition, MPI_Comm communicator, double reach, double overhang = 0.0);

  // Drops the store's ghosts and makes new ones from their owners' present state, sorted by owning rank, then id.
  // Positions must be wrapped. Collective.
  void build(GrainStore& store);

  // Brings the ghosts' position, velocity and angular velocity up to date.
  void refresh(GrainStore& store);
  void refresh(MovingGrains& grains);

  // Brings the ghosts' attached columns up to date.
  void refresh_attached(GrainStore& store);

  // Adds what the ranks have in `values` for their ghosts to the owners' entries: `width` integers a grain of the
  // store, so that the sums do not depend on any order. Entries of ghosts stay as they are. Always the same width.
  void add_to_owners(std::vector<std::int64_t>& values, int width);

private:
  struct Neighbour {
    int rank;
    std::vector<std::uint32_t> send;   // owned slots that are its ghosts
    std::size_t first = 0, count = 0;  // slots of the ghosts it owns
  };

  template <typename Read, typename Write>
  void exchange_motion(Read&& read, Write&& write);
  std::vector<PackedExchange::Neighbour> messages(int tag, std::size_t bytes_per_grain) const;

  Decomposition decomposition_;
  MPI_Comm communicator_;
  double reach_;
  std::vector<int> candidates_;        // ranks whose block is within reach of this rank's
  std::vector<Neighbour> neighbours_;  // ranks grains are sent to or received from
  PackedExchange motion_, attached_, values_;
  bool values_ready_ = false;  // values_ fits the present ghosts
};

}  // namespace thalweg::dem
