#include "driver/cost/load_balance.hpp"

#include "core/parallel/mpi_session.hpp"
#include "core/parallel/on_all_ranks.hpp"
#include "core/parallel/row_range.hpp"
#include "driver/bed/bed_flow.hpp"
#include "driver/cost/run_cost.hpp"
#include "driver/setup/build_system.hpp"
#include "io/hdf5/hdf5_archive.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace thalweg::driver {

namespace {

// Picoseconds of one core, as measured on AMD Zen 4 (benchmarks/coupled_bed); only their ratios matter.
constexpr double cell_work = 6500.0, link_work = 13000.0, sub_step_work = 45000.0;

using WorkProfile = std::array<std::vector<std::int64_t>, 3>;  // work in the cells with each coordinate along the axes

double work_of_sub_steps(const Case& c) { return static_cast<double>(grain_steps(c)) * sub_step_work; }

// A sphere, or a member of a clump.
double work_of_grain(const Case& c, double radius) {
  return links_of_sphere(2.0 * radius / c.domain.spacing) * link_work + work_of_sub_steps(c);
}

WorkProfile profile_of_cells(const Index3& cells) {
  const double all = static_cast<double>(cells[0]) * cells[1] * cells[2] * cell_work;
  WorkProfile profile;
  for (int a = 0; a < 3; ++a)
    profile[a].assign(static_cast<std::size_t>(cells[a]), static_cast<std::int64_t>(all / cells[a]));
  return profile;
}

// Shares work out evenly between two places (m) along an axis.
void add(double work, double lower, double upper, const Decomposition& box, int axis, WorkProfile& profile) {
  const int last = box.cells()[axis] - 1;
  const auto cell_at = [&](double place, int first) {
    return static_cast<int>(std::clamp(std::floor(place / box.spacing()), static_cast<double>(first), 1.0 * last));
  };
  if (!(lower <= upper)) return;  // of a state that is damaged: reading it will say so
  const int first_cell = cell_at(lower, 0), last_cell = cell_at(upper, first_cell);
  const auto each = static_cast<std::int64_t>(work / (last_cell - first_cell + 1));
  for (int k = first_cell; k <= last_cell; ++k) profile[axis][static_cast<std::size_t>(k)] += each;
}

// True if the work of a slab of ranks exceeds the mean by more than a tenth.
bool uneven(const Decomposition& cuts, const WorkProfile& profile) {
  constexpr double tolerated = 1.1;
  const Index3& layout = cuts.layout();
  for (int a = 0; a < 3; ++a)
    for (int slab = 0; slab < layout[a]; ++slab) {
      Index3 at{0, 0, 0};
      at[a] = slab;
      const Block block = cuts.block_of(cuts.rank_at(at));
      double all = 0.0, mine = 0.0;
      for (int k = 0; k < cuts.cells()[a]; ++k) {
        const auto work = static_cast<double>(profile[a][static_cast<std::size_t>(k)]);
        all += work;
        if (k >= block.lower[a] && k < block.upper[a]) mine += work;
      }
      if (mine * layout[a] > tolerated * all) return true;
    }
  return false;
}

Decomposition cuts_for(const WorkProfile& profile, const Decomposition& even) {
  return uneven(even, profile) ? even.balanced(profile) : even;
}

// This rank's share of the rows of a state.
std::vector<dem::PlacedSphere> grains_of(const std::filesystem::path& state, MPI_Comm communicator) {
  io::Hdf5Reader archive(state);
  const RowRange share(static_cast<std::int64_t>(archive.shape("grains/radius").at(0)), size_of(communicator),
                       rank_of(communicator));
  const auto rows = static_cast<std::size_t>(share.size());
  std::vector<double> radius(rows), position(3 * rows);
  archive.read("grains/radius", radius, share.box());
  archive.read("grains/position", position, share.box(3));
  std::vector<dem::PlacedSphere> grains;
  for (std::size_t n = 0; n < rows; ++n) grains.push_back({Vec3(&position[3 * n]), radius[n]});
  return grains;
}

}  // namespace

Decomposition balanced_partition(const Case& c, const Decomposition& even, std::span<const dem::PlacedSphere> grains,
                                 MPI_Comm communicator) {
  WorkProfile profile;
  for (int a = 0; a < 3; ++a) profile[a].assign(static_cast<std::size_t>(even.cells()[a]), 0);
  for (const dem::PlacedSphere& grain : grains)
    for (int a = 0; a < 3; ++a)
      add(work_of_grain(c, grain.radius), grain.position[a] - grain.radius, grain.position[a] + grain.radius, even, a,
          profile);
  const WorkProfile water = profile_of_cells(even.cells());
  for (int a = 0; a < 3; ++a) {
    MPI_Allreduce(MPI_IN_PLACE, profile[a].data(), even.cells()[a], MPI_INT64_T, MPI_SUM, communicator);
    for (std::size_t k = 0; k < profile[a].size(); ++k) profile[a][k] += water[a][k];
  }
  return cuts_for(profile, even);
}

Decomposition planned_partition(const Case& c, const Index3& layout) {
  const Decomposition even = decomposition_of(c, layout);
  if (c.system != SystemKind::resolved) return even;
  WorkProfile profile = profile_of_cells(even.cells());
  const double work = link_count(c) * link_work + static_cast<double>(grain_rows(c)) * work_of_sub_steps(c),
               height = settled_height(c);
  for (int a = 0; a < 3; ++a) {
    const double size = c.domain.size[a];
    add(work, 0.0, a == 2 && height > 0.0 ? std::min(height, size) : size, even, a, profile);
  }
  return cuts_for(profile, even);
}

Decomposition partition_of_run(const Case& c, MPI_Comm communicator, const Index3& layout,
                               const std::filesystem::path& state) {
  if (state.empty()) return planned_partition(c, layout);
  const Decomposition even = decomposition_of(c, layout);
  if (c.system != SystemKind::resolved || even.ranks() == 1) return even;
  std::vector<dem::PlacedSphere> grains;
  try {
    on_all_ranks(communicator, [&] { grains = grains_of(state, communicator); });
  } catch (const std::exception&) {
    return even;
  }
  return balanced_partition(c, even, grains, communicator);
}

std::string partition_text(const Case& c, const Decomposition& cuts) {
  if (c.system == SystemKind::continuum) return {};
  const Decomposition even = decomposition_of(c, cuts.layout());
  std::vector<std::string> axes;
  for (int a = 0; a < 3; ++a) {
    std::vector<int> ends;
    bool moved = false;
    for (int slab = 0; slab < cuts.layout()[a]; ++slab) {
      Index3 at{0, 0, 0};
      at[a] = slab;
      const int rank = cuts.rank_at(at);
      ends.push_back(cuts.block_of(rank).upper[a]);
      moved = moved || ends.back() != even.block_of(rank).upper[a];
    }
    if (moved) axes.push_back(fmt::format("{} at cells {}", "xyz"[a], fmt::join(ends, ", ")));
  }
  return axes.empty() ? "" : fmt::format("load-balanced blocks end along {}", fmt::join(axes, "; "));
}

}  // namespace thalweg::driver
