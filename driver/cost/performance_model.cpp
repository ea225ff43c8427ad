#include "driver/cost/performance_model.hpp"

#include "bodies/map/link_table.hpp"
#include "coupling/loads/grain_exchange.hpp"
#include "driver/bed/bed_flow.hpp"
#include "driver/bed/supplied_grains.hpp"
#include "driver/case/grain_setup.hpp"
#include "driver/cost/run_cost.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace thalweg::driver {

namespace {

// Populations sent for each cell of a face between blocks, and of an edge.
constexpr double populations_of_face = 5.0, populations_of_edge = 1.0;
// Bytes sent for a ghost: motion (position, velocity, spin) in each sub-step; once a step the sums of its links to the
// owner (force, torque, mass, pressure, LinkSums), and the load back.
constexpr double motion_bytes = 9 * 8.0;
// Fraction of the ghosts that may touch a grain of the rank and are therefore sent in sub-steps: in a wide bed 0.78 on
// 2 ranks, 0.6 on 32, 0.5 on 256 (docs/scaling.md).
constexpr double touching_ghosts = 0.6;
constexpr double sums_bytes = (8 + bodies::LinkSums::size) * 8.0,
                 shared_bytes = coupling::GrainExchange<double>::shared * 8.0;
// The run's decision to go on, and the largest speed of a grain; and about one a step where lists are made anew.
constexpr double reductions = 2.0;

// Relative excess of the fullest rank over the mean: one standard deviation of independently placed grains.
double unevenness(const RankWork& work) { return work.grains > 1.0 ? 1.0 / std::sqrt(work.grains) : 0.0; }

// Other ranks beside a block, in any of the directions that are wanted, each once.
template <typename Wanted>
double neighbours(const Decomposition& decomposition, int rank, const Wanted& wanted) {
  const Index3 at = decomposition.coordinates_of(rank);
  std::set<int> others;
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int other = decomposition.rank_at({at[0] + dx, at[1] + dy, at[2] + dz});
        if (wanted(std::abs(dx) + std::abs(dy) + std::abs(dz)) && other >= 0 && other != rank) others.insert(other);
      }
  return static_cast<double>(others.size());
}

// Bytes that leave the block for other ranks in a step of the lattice.
double halo_bytes(const Case& c, const Decomposition& decomposition, int rank) {
  const Index3 at = decomposition.coordinates_of(rank), n = decomposition.block_of(rank).size();
  double populations = 0.0;
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int axes = std::abs(dx) + std::abs(dy) + std::abs(dz);
        const int other = decomposition.rank_at({at[0] + dx, at[1] + dy, at[2] + dz});
        if (axes < 1 || axes > 2 || other < 0 || other == rank) continue;
        const double cells = (dx == 0 ? n[0] : 1.0) * (dy == 0 ? n[1] : 1.0) * (dz == 0 ? n[2] : 1.0);
        populations += cells * (axes == 1 ? populations_of_face : populations_of_edge);
      }
  return populations * bytes_per_value(c);
}

// m: how far beyond a block its rank knows grains.
double reach_of_ghosts(const Case& c) {
  const dem::GrainParameters grains = grain_parameters(c, {c.domain.size, periodic_axes(c.domain)});
  const double contacts = largest_diameter(c) + grains.skin;
  if (!has_fluid(c)) return contacts;
  return std::max(contacts, 0.5 * largest_diameter(c) + 2.5 * c.domain.spacing + 0.5 * grains.skin);
}

// Bytes that a frame of the fluid takes while it is written: numbers as they are sampled and as they are stored.
double bytes_of_frame(const Case& c, const io::FluidOutputKeys& keys, const Block& block) {
  if (!(keys.every > 0.0)) return 0.0;
  const double stored = keys.precision == io::FieldPrecision::double_ ? 8.0 : 4.0;
  const io::ShownCells shown = shown_cells(keys, cells_of(c.domain), c.domain.spacing);
  double bytes = 0.0;
  for (const FluidField field : keys.fields)
    bytes += components_of(field) * (8.0 * static_cast<double>(intersection(block, shown.region).volume()) +
                                     stored * static_cast<double>(shown.part_in(block).volume()));
  const bool gradients = std::any_of(keys.fields.begin(), keys.fields.end(), [](FluidField field) {
    return field == FluidField::vorticity || field == FluidField::q_criterion;
  });
  return gradients ? bytes + 24.0 * static_cast<double>(block.volume()) : bytes;  // velocities of the whole block
}

// Bytes that writing takes at most, beside the system itself: a frame, or what MPI-IO collects of a checkpoint where
// several ranks write one.
double bytes_of_writing(const Case& c, const Decomposition& decomposition, int rank, double lattice) {
  const Block block = decomposition.block_of(rank);
  double bytes = bytes_of_frame(c, c.output.fluid, block);
  for (const io::NamedFluidOutputKeys& part : c.output.fluid_parts)
    bytes = std::max(bytes, bytes_of_frame(c, part, block));
  // Measured with Open MPI 4.1: what the others have there, up to a buffer; one rank of several has a second one.
  constexpr double buffer = 16e6;
  const double ranks = decomposition.ranks(), collected = std::min(buffer, lattice) * (1.0 - 1.0 / ranks);
  return std::max(bytes, rank == 0 && ranks > 2.0 ? 2.0 * collected : collected);
}

struct Span {
  double lower, upper;
  double length() const { return std::max(0.0, upper - lower); }
};

// Quantities common to all ranks.
struct GrainsOfCase {
  explicit GrainsOfCase(const Case& c)
      : count(static_cast<double>(most_rows(c))),
        reach(c.grains.empty() ? 0.0 : reach_of_ghosts(c)),
        height(c.grains.empty() ? 0.0 : settled_height(c)),
        links(bytes_of_links(c)),
        observers(memory_of_observers(c)) {}

  double count, reach, height, links;  // of rows, m, m, bytes
  analysis::ObserverMemory observers;
};

// Extent of the grains along an axis, m.
Span filled(const Case& c, const GrainsOfCase& grains, int axis) {
  if (axis < 2 || !(grains.height > 0.0)) return {0.0, c.domain.size[axis]};
  return {0.0, std::min(grains.height, c.domain.size[axis])};
}

// The share of all grains that a block holds, widened by `reach` (m) where another rank is beside it.
double share_of_grains(const Case& c, const GrainsOfCase& grains, const Decomposition& decomposition, int rank,
                       double reach) {
  const Block block = decomposition.block_of(rank);
  const Index3 at = decomposition.coordinates_of(rank);
  double share = 1.0;
  for (int a = 0; a < 3; ++a) {
    const Span there = filled(c, grains, a);
    Span mine{block.lower[a] * c.domain.spacing, block.upper[a] * c.domain.spacing};
    for (const int side : {-1, 1}) {
      Index3 beside = at;
      beside[a] += side;
      const int other = decomposition.rank_at(beside);
      if (other < 0 || other == rank) continue;
      (side < 0 ? mine.lower : mine.upper) += side * reach;
    }
    // Beyond a periodic face there are grains as well.
    const bool around = decomposition.periodic()[a] && there.length() >= c.domain.size[a];
    const Span both = around ? mine : Span{std::max(mine.lower, there.lower), std::min(mine.upper, there.upper)};
    share *= std::min(1.0, both.length() / there.length());
  }
  return share;
}

RankWork work_of(const Case& c, const GrainsOfCase& grains, const Decomposition& decomposition, int rank) {
  RankWork work;
  const Index3 n = decomposition.cells(), own = decomposition.block_of(rank).size();
  const double all_cells = static_cast<double>(n[0]) * n[1] * n[2];
  work.memory = bytes_of_program();
  work.share_of_cells = static_cast<double>(decomposition.block_of(rank).volume()) / all_cells;
  if (has_fluid(c)) {
    work.cells = work.share_of_cells * all_cells;
    work.messages += neighbours(decomposition, rank, [](int axes) { return axes == 1 || axes == 2; });
    work.bytes += halo_bytes(c, decomposition, rank);
    work.rounds += 1.0;
    const double lattice = (own[0] + 2.0) * (own[1] + 2.0) * (own[2] + 2.0) * bytes_of_cell(c);
    work.memory += lattice + bytes_of_writing(c, decomposition, rank, lattice);
  }
  work.memory += (grains.observers.of_ids + grains.observers.while_saved) / decomposition.ranks() +
                 (rank == 0 ? grains.observers.on_first_rank : 0.0);
  if (c.grains.empty()) return work;
  const double count = grains.count;
  const auto sub_steps = static_cast<double>(grain_steps(c));
  work.share_of_grains = share_of_grains(c, grains, decomposition, rank, 0.0);
  work.grains = work.share_of_grains * count;
  work.ghosts = share_of_grains(c, grains, decomposition, rank, grains.reach) * count - work.grains;
  work.memory +=
      (work.grains + work.ghosts) * bytes_of_grain(c, decomposition.ranks()) + work.grains / count * grains.links;
  work.memory += bytes_of_bed_rows(c, decomposition.ranks()) + bytes_of_sizes(c);
  work.memory = std::max(work.memory, bytes_of_program() + bytes_of_placing(c, decomposition.ranks()));
  if (decomposition.ranks() == 1) return work;
  const double beside = neighbours(decomposition, rank, [](int axes) { return axes > 0; });
  work.messages += beside * (sub_steps + 1.0);
  work.bytes += work.ghosts * (touching_ghosts * sub_steps + 1.0) * motion_bytes;
  work.rounds += sub_steps + 1.0;
  if (!has_fluid(c)) return work;
  work.messages += 2.0 * beside;
  work.bytes += work.ghosts * (sums_bytes + shared_bytes);
  work.rounds += 2.0;
  return work;
}

}  // namespace

RankWork rank_work(const Case& c, const Decomposition& decomposition, int rank) {
  return work_of(c, GrainsOfCase(c), decomposition, rank);
}

StepTimes step_times(const RankWork& work, int ranks, const CoreSpeed& speed, const Network& network) {
  StepTimes times;
  times.computing = work.share_of_cells * speed.of_cells + work.share_of_grains * speed.of_grains;
  if (ranks == 1) return times;
  times.waiting = unevenness(work) * work.share_of_grains * speed.of_grains;
  times.sending = work.rounds * network.latency + work.messages * network.overhead + work.bytes / network.bandwidth;
  times.reducing = reductions * 2.0 * std::ceil(std::log2(ranks)) * network.latency;
  return times;
}

SlowestRank slowest_rank(const Case& c, const Decomposition& decomposition, const CoreSpeed& speed,
                         const Network& network) {
  const GrainsOfCase grains(c);
  SlowestRank slowest;
  double memory = 0.0;
  for (int rank = 0; rank < decomposition.ranks(); ++rank) {
    const RankWork work = work_of(c, grains, decomposition, rank);
    const StepTimes times = step_times(work, decomposition.ranks(), speed, network);
    memory = std::max(memory, work.memory);
    if (rank == 0 || times.sum() > slowest.times.sum()) slowest = {work, times};
  }
  slowest.work.memory = memory;
  return slowest;
}

}  // namespace thalweg::driver
