#include "dem/motion/grain_seed.hpp"

#include "core/base/error.hpp"
#include "dem/motion/cell_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace thalweg::dem {

namespace {

std::string place(const Vec3& p) { return fmt::format("({:g}, {:g}, {:g}) m", p[0], p[1], p[2]); }

void check_ids(std::span<const GrainSeed> seeds) {
  std::vector<bool> seen(seeds.size(), false);
  for (const GrainSeed& seed : seeds) {
    const bool in_range = seed.id >= 0 && seed.id < static_cast<GlobalId>(seeds.size());
    if (!in_range || seen[seed.id])
      throw InputError(fmt::format("Grain id {} is {}; {} grains must have the ids 0 to {}, each once.", seed.id,
                                   in_range ? "given twice" : "out of range", seeds.size(), seeds.size() - 1));
    seen[seed.id] = true;
  }
}

// Overlap of two grains (m) if it is larger than allowed; else 0.
double overlap_of(const GrainSeed& a, const GrainSeed& b, const PeriodicBox& box, double allowed_overlap) {
  if (is_fixed(a.motion) && is_fixed(b.motion)) return 0.0;
  if (a.clump >= 0 && a.clump == b.clump) return 0.0;
  const double overlap = a.radius + b.radius - box.difference(a.position, b.position).norm();
  return overlap > allowed_overlap * 2.0 * std::min(a.radius, b.radius) ? overlap : 0.0;
}

// Places in the list, in the order of ids.
std::vector<std::uint32_t> order_by_id(std::span<const GrainSeed> seeds) {
  std::vector<std::uint32_t> by_id(seeds.size());
  std::iota(by_id.begin(), by_id.end(), 0u);
  std::sort(by_id.begin(), by_id.end(), [&](std::uint32_t a, std::uint32_t b) { return seeds[a].id < seeds[b].id; });
  return by_id;
}

}  // namespace

double GrainSeed::mass() const {
  if (clump >= 0) return clump_mass;
  if (thickness > 0.0) return density * std::numbers::pi * radius * radius * thickness;
  return density * (4.0 / 3.0) * std::numbers::pi * radius * radius * radius;
}

double GrainSeed::contact_mass() const { return clump >= 0 ? clump_least_mass : mass(); }

void check(std::span<const GrainSeed> seeds, const PeriodicBox& box, std::span<const Plane> walls,
           double allowed_overlap) {
  check_ids(seeds);
  double largest = 0.0;
  for (const GrainSeed& seed : seeds) largest = std::max(largest, seed.radius);
  check_part(seeds, box, walls, allowed_overlap, largest);
}

void check_alone(const GrainSeed& seed, const PeriodicBox& box, std::span<const Plane> walls, double allowed_overlap) {
  if (!(std::isfinite(seed.radius) && seed.radius > 0.0))
    throw InputError(fmt::format("Grain {} at {} has radius {:g} m; it must be positive.", seed.id,
                                 place(seed.position), seed.radius));
  if (!(std::isfinite(seed.density) && seed.density > 0.0))
    throw InputError(fmt::format("Grain {} at {} has density {:g} kg/m^3; it must be positive.", seed.id,
                                 place(seed.position), seed.density));
  if (!seed.velocity.allFinite() || !seed.angular_velocity.allFinite())
    throw InputError(fmt::format("Grain {} at {} has a velocity that is not a number.", seed.id, place(seed.position)));
  for (int axis = 0; axis < 3; ++axis)
    if (!(seed.position[axis] >= 0.0 && seed.position[axis] <= box.size[axis]))
      throw InputError(
          fmt::format("Grain {} at {} has its centre outside the box; its {} must be between 0 and {:g} m.", seed.id,
                      place(seed.position), "xyz"[axis], box.size[axis]));
  if (is_fixed(seed.motion)) return;
  for (const Plane& wall : walls) {
    const WallView view = wall.seen_from(seed.position, box);
    const double overlap = seed.radius - view.distance;
    if (overlap > allowed_overlap * 2.0 * seed.radius)
      throw InputError(fmt::format(
          "Grain {} at {} with radius {:g} m reaches {:g} m into the wall with normal ({:g}, "
          "{:g}, {:g}); move it away by that much.",
          seed.id, place(seed.position), seed.radius, overlap, view.normal[0], view.normal[1], view.normal[2]));
  }
}

// Nothing pushes a disk out of its plane as long as all are in it, to the last bit, and gravity is along it.
void check_disk(const GrainSeed& seed, const GrainSeed& first) {
  if (seed.thickness != first.thickness)
    throw InputError(
        fmt::format("Grain {} is {:g} m thick and grain {} {:g} m; all must be spheres (0) or disks of "
                    "one thickness.",
                    seed.id, seed.thickness, first.id, first.thickness));
  if (seed.thickness == 0.0) return;
  if (seed.position[1] != first.position[1])
    throw InputError(fmt::format("Disk {} at {} is not in the plane y = {:g} m of disk {}; put all in one plane.",
                                 seed.id, place(seed.position), first.position[1], first.id));
  if (seed.velocity[1] != 0.0 || seed.angular_velocity[0] != 0.0 || seed.angular_velocity[2] != 0.0)
    throw InputError(
        fmt::format("Disk {} moves or turns out of the x-z plane; its velocity along y and its angular "
                    "velocity along x and z must be zero.",
                    seed.id));
}

void check_periodic_axes(const PeriodicBox& box, double largest_radius, bool disks) {
  for (int axis = 0; axis < 3; ++axis)
    if (box.periodic[axis] && box.size[axis] < 4.0 * largest_radius && !(disks && axis == 1))
      throw InputError(
          fmt::format("The box is {:g} m along its periodic axis {}; it must be at least two of the "
                      "largest grain diameters, {:g} m, so that grains meet only once.",
                      box.size[axis], "xyz"[axis], 4.0 * largest_radius));
}

std::optional<Overlap> first_overlap(std::span<const GrainSeed> seeds, const PeriodicBox& box, double allowed_overlap,
                                     double largest_radius) {
  const std::vector<std::uint32_t> by_id = order_by_id(seeds);
  std::vector<Vec3> points;
  for (const std::uint32_t n : by_id) points.push_back(box.wrapped(seeds[n].position));
  const CellGrid grid(box, 2.0 * largest_radius, points);
  const auto count = static_cast<std::uint32_t>(seeds.size());
  const std::pair<std::uint32_t, std::uint32_t> none{count, count};
  std::pair<std::uint32_t, std::uint32_t> lowest = none;
  grid.for_each_near_pair([&](std::uint32_t m, std::uint32_t n) {
    const std::uint32_t a = grid.order()[m], b = grid.order()[n];
    const double reach = seeds[by_id[a]].radius + seeds[by_id[b]].radius;
    if (box.difference(points[a], points[b]).squaredNorm() > reach * reach) return;
    const std::pair<std::uint32_t, std::uint32_t> pair = std::minmax(a, b);
    if (pair < lowest && overlap_of(seeds[by_id[a]], seeds[by_id[b]], box, allowed_overlap) > 0.0) lowest = pair;
  });
  if (lowest == none) return std::nullopt;
  const GrainSeed &a = seeds[by_id[lowest.first]], &b = seeds[by_id[lowest.second]];
  return Overlap{a.id, b.id,
                 fmt::format("Grain {} at {} and grain {} at {} overlap by {:g} m at the start; they must not touch "
                             "by more than {:g} diameters.",
                             a.id, place(a.position), b.id, place(b.position), overlap_of(a, b, box, allowed_overlap),
                             allowed_overlap)};
}

void check_part(std::span<const GrainSeed> seeds, const PeriodicBox& box, std::span<const Plane> walls,
                double allowed_overlap, double largest_radius) {
  const std::vector<std::uint32_t> by_id = order_by_id(seeds);
  for (const std::uint32_t n : by_id) check_alone(seeds[n], box, walls, allowed_overlap);
  for (const Plane& wall : walls) check_images(wall, box, largest_radius);
  if (seeds.empty()) return;
  const GrainSeed& first = seeds[by_id.front()];
  for (const std::uint32_t n : by_id) check_disk(seeds[n], first);
  check_periodic_axes(box, largest_radius, first.thickness > 0.0);
  if (const std::optional<Overlap> overlap = first_overlap(seeds, box, allowed_overlap, largest_radius))
    throw InputError(overlap->text);
}

}  // namespace thalweg::dem
