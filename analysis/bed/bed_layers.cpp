#include "analysis/bed/bed_layers.hpp"

#include "analysis/bed/union_of_spheres.hpp"
#include "analysis/tools/sphere_in_layer.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/parallel/ranks.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg::analysis {

namespace {

// Volume of each clump over that of its members together, which may overlap.
std::map<GlobalId, double> shares_of_members(const GrainView& grains) {
  std::map<GlobalId, double> shares;
  for (std::size_t i = 0; i < grains.id.size(); ++i)
    if (grains.is_member(i)) shares[grains.clump[i]] += volume_of(grains.radius[i], grains.disk_thickness);
  for (const ClumpState& clump : grains.clumps) shares.at(clump.id) = clump.volume / shares.at(clump.id);
  return shares;
}

}  // namespace

BedLayers::BedLayers(MPI_Comm communicator, const PeriodicBox& box, double window, double disk_thickness,
                     const BedObstacles& obstacles)
    : communicator_(communicator),
      box_(box),
      layers_(thin_layers(box.size.z(), window)),
      thickness_(box.size.z() / layers_),
      width_(disk_thickness > 0.0 ? disk_thickness : box.size.y()),
      obstacles_(obstacles.spheres),
      solids_below_(obstacles.solids_below ? obstacles.solids_below(layers_) : std::vector<double>()),
      floating_density_(obstacles.floating_density) {}

BedLayers::Bed BedLayers::bed(const Snapshot& snapshot) const {
  std::vector<double> grains = grains_below(snapshot), obstacles = spheres_below(snapshot);
  if (obstacles_are_the_bed(snapshot)) grains = std::exchange(obstacles, {});
  if (obstacles.empty())
    obstacles = solids_below_;
  else
    for (std::size_t k = 0; k < solids_below_.size(); ++k) obstacles[k] += solids_below_[k];
  const VolumeBelow below{grains, thickness_, box_.size.x() * width_, obstacles};
  const double height = bed_height(below, thin_layers_a_window / 2);
  return {height, bulk_solid_fraction(below), obstacles_above(below, height)};
}

// Of each grain here, whether it floats over a bed of others; empty where there is no such grain.
std::vector<char> BedLayers::floating(const Snapshot& snapshot) const {
  if (floating_density_ <= 0.0) return {};
  const GrainView& grains = snapshot.grains;
  std::map<GlobalId, double> of_clump;  // kg/m^3
  for (const ClumpState& clump : grains.clumps) of_clump[clump.id] = clump.mass / clump.volume;
  std::vector<char> floating(grains.id.size(), 0);
  std::int64_t afloat = 0, others = 0;
  for (std::size_t i = 0; i < floating.size(); ++i) {
    const double density = grains.is_member(i) ? of_clump.at(grains.clump[i])
                                               : grains.mass[i] / volume_of(grains.radius[i], grains.disk_thickness);
    const bool is_free = (grains.held(i) & 1) == 0;
    floating[i] = is_free && density <= floating_density_ ? 1 : 0;
    if (floating[i] != 0)
      ++afloat;
    else if (!obstacles_.has(grains.id[i]))
      ++others;
  }
  afloat = sum_over_ranks(communicator_, afloat);
  others = sum_over_ranks(communicator_, others);
  return afloat > 0 && others > 0 ? floating : std::vector<char>();
}

std::vector<char> BedLayers::not_of_the_bed(const Snapshot& snapshot) const {
  std::vector<char> found = floating(snapshot);
  const std::vector<char> obstacles = obstacles_.in_the_bed(snapshot);
  if (found.empty()) return obstacles;
  for (std::size_t i = 0; i < obstacles.size(); ++i) found[i] |= obstacles[i];
  return found;
}

std::vector<double> BedLayers::spheres_below(const Snapshot& snapshot) const {
  if (!obstacles_.any()) return {};
  const GrainView& grains = snapshot.grains;
  std::vector<SphereInBed> spheres;
  for (std::size_t i = 0; i < grains.id.size(); ++i)
    if (obstacles_.has(grains.id[i])) {
      const Vec3& centre = grains.position[i];
      spheres.push_back({grains.id[i], {centre.x(), centre.y(), centre.z()}, grains.radius[i]});
    }
  spheres = Ranks(communicator_).gathered(std::move(spheres));
  std::sort(spheres.begin(), spheres.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return union_below(box_, spheres, layers_);
}

std::vector<double> BedLayers::grains_below(const Snapshot& snapshot) const {
  const std::vector<double> in_layer =
      reproducible_sums_by_bin(communicator_, layers_, 1,
                               [&, shares = shares_of_members(snapshot.grains), floating = floating(snapshot)](
                                   const TermTaker& take) { give_volumes(snapshot.grains, shares, floating, take); });
  std::vector<double> below{0.0};
  for (const double volume : in_layer) below.push_back(below.back() + volume);
  return below;
}

// The volume of each grain in each layer, inside the box.
void BedLayers::give_volumes(const GrainView& grains, const std::map<GlobalId, double>& shares,
                             const std::vector<char>& floating, const TermTaker& take) const {
  for (std::size_t i = 0; i < grains.id.size(); ++i) {
    if (obstacles_.has(grains.id[i]) || (!floating.empty() && floating[i] != 0)) continue;
    const double radius = grains.radius[i], foot = grains.position[i].z() - radius;
    const double share = grains.is_member(i) ? shares.at(grains.clump[i]) : 1.0;
    const int first = static_cast<int>(std::floor(foot / thickness_));
    const int last = static_cast<int>(std::floor((foot + 2.0 * radius) / thickness_));
    for (int layer = std::max(0, first); layer <= std::min(layers_ - 1, last); ++layer) {
      const double lower = layer * thickness_ - foot;
      const double volume = share * volume_between(radius, grains.disk_thickness, lower, lower + thickness_);
      take(layer, {&volume, 1});
    }
  }
}

}  // namespace thalweg::analysis
