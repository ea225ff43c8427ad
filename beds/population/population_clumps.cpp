#include "beds/population/population_clumps.hpp"

#include "beds/shapes/mesh_clump.hpp"
#include "beds/shapes/union_by_lines.hpp"
#include "core/base/counter_random.hpp"
#include "core/base/error.hpp"
#include "core/geometry/symmetric_pairs.hpp"
#include "dem/clumps/clump_of_body.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace thalweg::beds {
namespace {

// The draws of counter_random.hpp that orientations use; placements use small numbers, sizes 2^40.
constexpr std::uint64_t first_orientation_draw = std::uint64_t{1} << 41;

constexpr double turn = 2.0 * std::numbers::pi;

dem::BodyMoments moments_of(const BodyKeys& body) {
  dem::BodyMoments moments;
  moments.volume = body.volume;
  moments.centre = body.centre;
  for (std::size_t n = 0; n < body.inertia.size(); ++n) {
    const auto& [row, column] = symmetric_pairs[n];
    moments.inertia(row, column) = moments.inertia(column, row) = body.inertia[n];
  }
  return moments;
}

}  // namespace

std::shared_ptr<const dem::ClumpShape> clump_shape_of(const Population& population) {
  std::vector<dem::PlacedSphere> members;
  for (const MemberKeys& member : population.shape->clump) members.push_back({member.position, 0.5 * member.diameter});
  if (const std::optional<BodyKeys>& body = population.shape->body) {
    if (population.thickness > 0.0)
      throw InputError("The clump has a body in space, and disks have none; remove shape.body, or disks.");
    return std::make_shared<const dem::ClumpShape>(clump_shape(members, moments_of(*body)));
  }
  return std::make_shared<const dem::ClumpShape>(clump_shape(members, population.thickness));
}

ClumpShapes::ClumpShapes(const Population& population) : as_given_(clump_shape_of(population)) {
  by_diameter_.emplace(2.0 * as_given_->equivalent_radius(), as_given_);
}

std::shared_ptr<const dem::ClumpShape> ClumpShapes::of(double diameter) {
  std::shared_ptr<const dem::ClumpShape>& shape = by_diameter_[diameter];
  if (!shape)
    shape =
        std::make_shared<const dem::ClumpShape>(scaled(*as_given_, diameter / (2.0 * as_given_->equivalent_radius())));
  return shape;
}

std::array<double, 3> clump_axes(const dem::ClumpShape& shape) {
  std::array<double, 3> axes;
  for (int n = 0; n < 3; ++n)
    axes[static_cast<std::size_t>(n)] =
        std::sqrt(10.0 * std::max(0.0, shape.moments.sum() - 2.0 * shape.moments[n]) / shape.volume);
  std::sort(axes.begin(), axes.end());
  return axes;
}

void take_surface(ShapeKeys& shape, const TriangleMesh& surface) {
  ClumpFit fit;
  if (shape.spheres) fit.spheres = static_cast<int>(std::min<std::int64_t>(*shape.spheres, ClumpFit::most_spheres));
  fit.tolerance = shape.tolerance;
  const MeshClump made = clump_of(surface, fit);
  shape.clump.clear();
  for (const dem::PlacedSphere& sphere : made.spheres) shape.clump.push_back({sphere.position, 2.0 * sphere.radius});
  shape.inscribed = union_by_lines(made.inscribed).volume / made.body.volume;
  shape.body.emplace();
  shape.body->volume = made.body.volume;
  shape.body->centre = made.body.centre;
  for (const auto& [row, column] : symmetric_pairs) shape.body->inertia.push_back(made.body.inertia(row, column));
  shape.stl.reset();
  shape.spheres.reset();
  shape.tolerance.reset();
  shape.scale.reset();
}

dem::Quaternion orientation_of(const Population& population, std::size_t grain) {
  if (population.orientation) {
    const Vec3 axis = population.orientation->axis.normalized();
    const double half = 0.5 * population.orientation->angle, s = std::sin(half);
    return dem::normalised({std::cos(half), s * axis[0], s * axis[1], s * axis[2]});
  }
  const auto draw = [&](std::uint64_t n) {
    return uniform_random(static_cast<std::uint64_t>(population.placement.seed), grain, first_orientation_draw + n);
  };
  if (population.thickness > 0.0) {
    const double half = 0.5 * turn * draw(0);
    return dem::normalised({std::cos(half), 0.0, std::sin(half), 0.0});
  }
  const double u = draw(0), inner = std::sqrt(1.0 - u), outer = std::sqrt(u), a = turn * draw(1), b = turn * draw(2);
  return dem::normalised({outer * std::cos(b), inner * std::sin(a), inner * std::cos(a), outer * std::sin(b)});
}

std::vector<std::span<const BedGrain>> bodies_of(std::span<const BedGrain> rows) {
  std::vector<std::span<const BedGrain>> bodies;
  for (std::size_t first = 0; first < rows.size();) {
    std::size_t end = first + 1;
    while (end < rows.size() && rows[first].clump >= 0 && rows[end].clump == rows[first].clump) ++end;
    bodies.push_back(rows.subspan(first, end - first));
    first = end;
  }
  return bodies;
}

namespace {

// Vectors (m) from the first member to each. A clump may be longer than half a periodic axis, so that the nearest
// image of the first is not the right one: the way goes from member to near member, each time to the nearest pair.
std::vector<Vec3> places_from_first(std::span<const BedGrain> rows, const PeriodicBox& box) {
  std::vector<Vec3> places(rows.size(), Vec3::Zero());
  std::vector<std::size_t> found{0}, left;
  for (std::size_t n = 1; n < rows.size(); ++n) left.push_back(n);
  while (!left.empty()) {
    std::size_t from = 0, next = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (const std::size_t known : found)
      for (std::size_t n = 0; n < left.size(); ++n) {
        const double distance = box.difference(rows[left[n]].position, rows[known].position).norm();
        if (distance < nearest) nearest = distance, from = known, next = n;
      }
    const std::size_t member = left[next];
    const Vec3 by_way = places[from] + box.difference(rows[member].position, rows[from].position);
    places[member] = box.difference(rows[member].position, rows.front().position);  // the same but for whole boxes
    for (int axis = 0; axis < 3; ++axis)
      if (box.periodic[static_cast<std::size_t>(axis)])
        places[member][axis] += box.size[axis] * std::round((by_way[axis] - places[member][axis]) / box.size[axis]);
    found.push_back(member);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(next));
  }
  return places;
}

}  // namespace

namespace {

// Members in space, about the first.
dem::ClumpShape shape_of(const BedBody& body, std::vector<dem::PlacedSphere> members, double thickness) {
  const auto& [w, x, y, z] = body.orientation;
  dem::ClumpShape shape;
  shape.volume = body.volume;
  shape.moments = body.moments;
  shape.centre = body.from_first;
  shape.principal = {w, x, y, z};
  shape.thickness = thickness;
  const Eigen::Matrix3d turn = rotation_matrix(shape.principal);
  for (dem::PlacedSphere& member : members) {
    member.position = turn.transpose() * (member.position - shape.centre);
    shape.bounding_radius = std::max(shape.bounding_radius, member.position.norm() + member.radius);
  }
  shape.members = std::move(members);
  return shape;
}

}  // namespace

dem::ClumpSeed clump_from(std::span<const BedGrain> rows, const PeriodicBox& box, double thickness) {
  const BedGrain& first = rows.front();
  std::vector<dem::PlacedSphere> members;
  for (const Vec3& place : places_from_first(rows, box)) members.push_back({place, rows[members.size()].radius});
  dem::ClumpSeed clump;
  clump.shape = std::make_shared<const dem::ClumpShape>(
      first.body ? shape_of(*first.body, std::move(members), thickness) : clump_shape(members, thickness));
  clump.density = first.density;
  clump.position = box.wrapped(first.position + clump.shape->centre);
  clump.velocity = first.velocity + first.angular_velocity.cross(clump.shape->centre);
  clump.angular_velocity = first.angular_velocity;
  return clump;
}

ClumpFigures figures_of(const dem::ClumpShape& shape, double density, std::int64_t count) {
  return {count, static_cast<double>(count) * shape.volume, shape.least_contact_mass(density),
          2.0 * shape.bounding_radius, clump_axes(shape)[0]};
}

ClumpFigures figures_of(const Population& population, const dem::ClumpShape& as_given) {
  ClumpFigures figures =
      figures_of(scaled(as_given, population.scale_of(population.finest())), population.density, population.count);
  figures.largest_extent = 2.0 * as_given.bounding_radius * population.scale_of(population.coarsest());
  if (population.diameters.empty()) return figures;
  figures.volume = 0.0;
  for (const double diameter : population.diameters) figures.volume += population.volume_of(diameter);
  return figures;
}

}  // namespace thalweg::beds
