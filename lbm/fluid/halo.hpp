// Halo exchange of the populations: to each neighbouring block go exactly the populations that cross into it, five for
// a face and one for an edge, in one packed message per neighbouring rank. A block that is its own periodic neighbour
// copies to itself.
#pragma once

#include "core/parallel/decomposition.hpp"
#include "core/parallel/packed_exchange.hpp"
#include "lbm/lattice/populations.hpp"
#include "lbm/walls/walls.hpp"

#include <vector>

namespace thalweg::lbm {

template <typename Real>
class Halo {
public:
  // populations and walls must outlive the halo and stay where they are in memory.
  Halo(const Decomposition& decomposition, MPI_Comm communicator, Populations<Real>& populations, Walls<Real>& walls);

  bool has_other_ranks() const { return exchange_.neighbours() > 0; }

  void start();   // packs and sends
  void finish();  // waits and unpacks
  bool under_way() const { return exchange_.under_way(); }

private:
  // count Reals, stride apart; where they are in the swapped and in the moved arrangement.
  struct StridedRange {
    Real* at[2];
    int count;
    std::ptrdiff_t stride;
  };
  struct Message {
    int rank;
    std::vector<StridedRange> send, receive;
  };

  Message& message_to(int rank);
  void add_neighbour(int rank, const Index3& towards, bool sending);
  void add_population(std::vector<StridedRange>& ranges, int direction, const Index3& begin, const Index3& end);
  void add_wall_lines(std::vector<StridedRange>& ranges, const Index3& towards, bool sending);

  Populations<Real>& populations_;
  Walls<Real>& walls_;
  std::vector<Message> messages_;  // the one to the own rank first, if any
  int self_ = -1;                  // index of that one
  PackedExchange exchange_;
};

}  // namespace thalweg::lbm
