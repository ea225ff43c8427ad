#include "beds/files/bed_overlap_check.hpp"

#include "core/base/error.hpp"
#include "dem/motion/grain_seed.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace thalweg::beds {
namespace {

// A grain on its way to the ranks that compare it with its neighbours.
struct PlacedRow {
  GlobalId id, clump;
  double radius, position[3];
};

// The bed cut across its longest axis: one slab per rank, or fewer, so that none is narrower than `reach`.
class Slabs {
public:
  // reach: m, of two centres that touch. Collective.
  Slabs(std::span<const BedGrain> rows, const PeriodicBox& box, double reach, const Ranks& ranks)
      : box_(box), reach_(reach) {
    double longest = -1.0;
    for (int axis = 0; axis < 3; ++axis) {
      double lower = std::numeric_limits<double>::max(), upper = -lower;
      for (const BedGrain& row : rows) {
        const double place = box.wrapped(row.position)[axis];
        lower = std::min(lower, place);
        upper = std::max(upper, place);
      }
      lower = ranks.smallest(lower);
      upper = ranks.largest(upper);
      if (upper - lower <= longest) continue;
      longest = upper - lower;
      axis_ = axis;
      lower_ = lower;
      upper_ = upper;
    }
    count_ = static_cast<int>(std::clamp(longest / reach, 1.0, static_cast<double>(ranks.count())));
    width_ = std::max(longest, reach) / count_;
  }

  // The ranks whose slabs are within reach of a point (m, wrapped) or one of its periodic images, each once.
  std::vector<int> reached(const Vec3& point) const {
    std::vector<int> slabs;
    const double size = box_.periodic[static_cast<std::size_t>(axis_)] ? box_.size[axis_] : 0.0;
    for (const int image : {-1, 0, 1}) {
      const double place = point[axis_] + image * size, from = place - reach_, to = place + reach_;
      if (to < lower_ || from > upper_) continue;
      for (int slab = slab_of(from); slab <= slab_of(to); ++slab) slabs.push_back(slab);
    }
    std::sort(slabs.begin(), slabs.end());
    slabs.erase(std::unique(slabs.begin(), slabs.end()), slabs.end());
    return slabs;
  }

private:
  int slab_of(double place) const {
    return static_cast<int>(std::clamp((place - lower_) / width_, 0.0, static_cast<double>(count_ - 1)));
  }

  PeriodicBox box_;
  double reach_, lower_ = 0.0, upper_ = 0.0, width_ = 0.0;  // m
  int axis_ = 0, count_ = 1;
};

dem::GrainSeed seed_of(const PlacedRow& row) {
  dem::GrainSeed seed;
  seed.id = row.id;
  seed.clump = row.clump;
  seed.radius = row.radius;
  seed.position = Vec3(row.position);
  return seed;
}

// Rows in the slab of this rank, and those that may overlap them.
std::vector<dem::GrainSeed> rows_by_place(std::span<const BedGrain> rows, const PeriodicBox& box, double reach,
                                          const Ranks& ranks) {
  const Slabs slabs(rows, box, reach, ranks);
  std::vector<PlacedRow> sent;
  std::vector<int> home;
  for (const BedGrain& row : rows) {
    const Vec3& at = row.position;
    for (const int rank : slabs.reached(box.wrapped(at))) {
      sent.push_back({row.id, row.clump, row.radius, {at[0], at[1], at[2]}});
      home.push_back(rank);
    }
  }
  std::vector<dem::GrainSeed> seeds;
  for (const PlacedRow& row : ranks.exchanged(std::move(sent), home)) seeds.push_back(seed_of(row));
  return seeds;
}

}  // namespace

void refuse_overlaps(std::span<const BedGrain> rows, const PeriodicBox& box, double allowed_overlap,
                     double largest_radius, const Ranks& ranks) {
  constexpr double rounding = 1e-9;
  using Pair = std::pair<GlobalId, GlobalId>;
  const std::vector<dem::GrainSeed> seeds = rows_by_place(rows, box, (1.0 + rounding) * 2.0 * largest_radius, ranks);
  const std::optional<dem::Overlap> mine = first_overlap(seeds, box, allowed_overlap, largest_radius);
  struct PairOfRank {
    GlobalId first, second;
  };
  std::vector<PairOfRank> found;
  if (mine) found.push_back({mine->first, mine->second});
  found = ranks.gathered(std::move(found));
  if (found.empty()) return;
  Pair lowest{found.front().first, found.front().second};
  for (const PairOfRank& pair : found) lowest = std::min(lowest, Pair{pair.first, pair.second});
  ranks.on_all([&] {
    if (mine && Pair{mine->first, mine->second} == lowest) throw InputError(mine->text);
  });
}

}  // namespace thalweg::beds
