// The grains of a rank that are ghosts elsewhere, and the one packed message per neighbour that updates them.
// In sub-steps only those that may touch a grain of the other rank are sent.
#pragma once

#include "core/parallel/decomposition.hpp"
#include "core/parallel/packed_exchange.hpp"
#include "dem/contact/neighbour_list.hpp"
#include "dem/motion/grain_store.hpp"
#include "dem/motion/packed_grain_state.hpp"

#include <mpi.h>

#include <cstdint>
#include <span>
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

  // Makes refresh(PackedGrainState&) leave out ghosts that are in none of these pairs, until the next build(). pairs:
  // all pairs of an owned grain with another one up to some gap, the same gap on every rank, so that both ranks of a
  // pair know it and one sends what the other expects.
  void follow(std::span<const PairContact> pairs, const GrainStore& store);

  // Brings the ghosts' position, velocity and angular velocity up to date.
  void refresh(GrainStore& store);
  void refresh(PackedGrainState& grains);

  // Brings some of the ghosts' attached columns up to date: `count` of them from `first` on. count must always be the
  // same.
  void refresh_attached(GrainStore& store, std::size_t first, std::size_t count);

  // Adds the entries that ranks have in `values` for their ghosts to the owners' entries: `width` integers per grain of
  // the store, so that the sums depend on no order. Entries of ghosts stay as they are. width is the same on every
  // rank.
  void add_to_owners(std::vector<std::int64_t>& values, int width);

private:
  struct Neighbour {
    int rank;
    std::vector<std::uint32_t> send;    // owned slots that are its ghosts
    std::vector<std::uint32_t> ghosts;  // slots of those it owns
  };

  static std::vector<PackedExchange::Neighbour> messages(const std::vector<Neighbour>& neighbours, int tag,
                                                         std::size_t bytes_per_grain);
  template <typename Read, typename Write>
  static void exchange_motion(const std::vector<Neighbour>& neighbours, PackedExchange& exchange, Read&& read,
                              Write&& write);

  Decomposition decomposition_;
  MPI_Comm communicator_;
  double reach_;
  std::vector<int> candidates_;        // ranks whose block is within reach of this rank's
  std::vector<Neighbour> neighbours_;  // ranks grains are sent to or received from; ghosts side by side
  std::vector<Neighbour> followed_;    // the same without what refresh(PackedGrainState&) leaves out, where it does
  PackedExchange motion_, followed_motion_, attached_, values_;
  bool follows_ = false;         // true if follow() has been called for the present ghosts
  int values_width_ = 0;         // for which values_ fits the present ghosts; 0: none
  bool attached_ready_ = false;  // attached_ fits them
};

}  // namespace thalweg::dem
