#include "beds/packing/packing.hpp"

#include "core/base/counter_random.hpp"
#include "core/base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace thalweg::beds {

double settled_fraction(const PeriodicBox& box, double diameter, bool disks) {
  if (disks) return settled_disks;
  double fraction = settled_bed;
  for (const int axis : {0, 1})
    if (!box.periodic[axis]) fraction *= 1.0 - std::min(diameter / box.size[axis], 1.0) / 3.0;
  return fraction;
}

bool wraps(const PeriodicBox& box, const Region& region, int axis) {
  return box.periodic[axis] && region.upper[axis] - region.lower[axis] >= box.size[axis] * (1.0 - 1e-12);
}

void check_region(const PeriodicBox& box, const Region& region) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(region.lower[axis] >= 0.0 && region.lower[axis] < region.upper[axis] &&
          region.upper[axis] <= box.size[axis] * (1.0 + 1e-12)))
      throw InputError(
          fmt::format("The region for grains reaches from {:g} to {:g} m along {}; it must lie between 0 and "
                      "{:g} m.",
                      region.lower[axis], region.upper[axis], "xyz"[axis], box.size[axis]));
}

namespace {

// m, along an axis, without the clearance to faces that are not periodic.
double sites_extent(const PeriodicBox& box, const Region& region, int axis, double clearance) {
  return region.upper[axis] - region.lower[axis] - (wraps(box, region, axis) ? 0.0 : 2.0 * clearance);
}

struct Lattice {
  std::array<std::int64_t, 3> count{0, 0, 0};
  double spacing = 0.0;  // m, the smallest of the three
};

// The lattice of at least `count` sites whose smallest spacing is widest; spacing 0 if none is as wide as a diameter.
Lattice widest_lattice(const Vec3& extent, std::int64_t count, const std::array<std::int64_t, 3>& most) {
  Lattice best;
  for (std::int64_t nx = 1; nx <= most[0]; ++nx)
    for (std::int64_t ny = 1; ny <= most[1]; ++ny) {
      const std::int64_t nz = (count + nx * ny - 1) / (nx * ny);
      if (nz > most[2]) continue;
      const double spacing = std::min({extent[0] / static_cast<double>(nx), extent[1] / static_cast<double>(ny),
                                       extent[2] / static_cast<double>(nz)});
      // Among lattices with the same spacing, the one with fewest spare sites is filled most evenly.
      const bool fewer = spacing == best.spacing && nx * ny * nz < best.count[0] * best.count[1] * best.count[2];
      if (spacing > best.spacing || fewer) best = {{nx, ny, nz}, spacing};
    }
  return best;
}

}  // namespace

std::array<std::int64_t, 3> UniformSites::most(const PeriodicBox& box, const Region& region, double radius,
                                               double clearance) {
  std::array<std::int64_t, 3> most{};
  for (int axis = 0; axis < 3; ++axis) {
    if (region.plane && axis == 1) {
      most[1] = 1;  // one sheet, in the middle
      continue;
    }
    // A box made for n grains must take n in spite of rounding, also that of a spacing whose whole cells make the box.
    // The overlap that this allows is below allowed_initial_overlap.
    const double extent = sites_extent(box, region, axis, clearance);
    most[static_cast<std::size_t>(axis)] = std::max<std::int64_t>(
        0, static_cast<std::int64_t>(std::floor(extent / (2.0 * radius) * (1.0 + whole_number_tolerance))));
  }
  return most;
}

UniformSites::UniformSites(const PeriodicBox& box, const Region& region, std::int64_t count, double radius,
                           double clearance, std::uint64_t seed)
    : box_(box),
      region_(region),
      count_(count),
      seed_(seed),
      lower_(region.lower),
      extent_(region.upper - region.lower) {
  check_region(box, region);
  const double diameter = 2.0 * radius;
  for (int axis = 0; axis < 3; ++axis) {
    if (region.plane && axis == 1) continue;
    if (!wraps(box, region, axis)) lower_[axis] += clearance;
    extent_[axis] = sites_extent(box, region, axis, clearance);
  }
  const std::array<std::int64_t, 3> most = UniformSites::most(box, region, radius, clearance);
  if (count > most[0] * most[1] * most[2])
    throw InputError(
        fmt::format("{} grains of {:g} m do not fit on a lattice in {:g} x {:g} x {:g} m: {} would; use fewer "
                    "or smaller grains or a larger region.",
                    count, diameter, extent_[0], extent_[1], extent_[2], most[0] * most[1] * most[2]));
  if (count == 0) return;
  Vec3 between = extent_;
  if (region.plane) between[1] = std::numeric_limits<double>::infinity();
  const Lattice lattice = widest_lattice(between, count, most);
  const double room = std::max(0.0, 0.5 * (lattice.spacing - diameter));
  along_ = lattice.count;
  jitter_ = std::min(0.01 * diameter, 0.999 * room);
}

Vec3 UniformSites::centre(std::int64_t grain) const {
  const std::int64_t sites = along_[0] * along_[1] * along_[2], site = grain * sites / count_;
  const std::int64_t at[3] = {site % along_[0], site / along_[0] % along_[1], site / (along_[0] * along_[1])};
  Vec3 centre;
  for (int axis = 0; axis < 3; ++axis) {
    if (region_.plane && axis == 1) {
      centre[1] = 0.5 * (region_.lower[1] + region_.upper[1]);
      continue;
    }
    const double step = extent_[axis] / static_cast<double>(along_[axis]);
    const double draw = uniform_random(seed_, static_cast<std::uint64_t>(grain), axis);
    centre[axis] = lower_[axis] + (static_cast<double>(at[axis]) + 0.5) * step + jitter_ * (2.0 * draw - 1.0);
  }
  return box_.wrapped(centre);
}

std::vector<Vec3> uniform_packing(const PeriodicBox& box, const Region& region, std::int64_t count, double radius,
                                  double clearance, std::uint64_t seed) {
  const UniformSites sites(box, region, count, radius, clearance, seed);
  std::vector<Vec3> centres;
  for (std::int64_t grain = 0; grain < count; ++grain) centres.push_back(sites.centre(grain));
  return centres;
}

}  // namespace thalweg::beds
