#include "dem/clumps/clump_seed.hpp"

#include "core/base/error.hpp"
#include "dem/clumps/clump_of_body.hpp"
#include "dem/clumps/sphere_union_inertia.hpp"
#include "dem/motion/grain_volume.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::dem {

namespace {

void check_members(std::span<const PlacedSphere> members, double thickness) {
  if (members.empty()) throw InputError("A clump has no members; give it at least one sphere.");
  for (const PlacedSphere& member : members) {
    if (!(std::isfinite(member.radius) && member.radius > 0.0) || !member.position.allFinite())
      throw InputError(
          fmt::format("A member of a clump, at ({:g}, {:g}, {:g}) m, has radius {:g} m; it must be positive.",
                      member.position[0], member.position[1], member.position[2], member.radius));
    if (thickness > 0.0 && member.position[1] != members.front().position[1])
      throw InputError(
          fmt::format("A disk of a clump is at y = {:g} m and another at {:g} m; they must be in one plane.",
                      member.position[1], members.front().position[1]));
  }
}

// The right-handed frame in which the inertia is diagonal, its columns in the frame given.
Eigen::Matrix3d principal_axes(const Eigen::Matrix3d& inertia) {
  Eigen::Matrix3d axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvectors();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

}  // namespace

double ClumpShape::equivalent_radius() const { return radius_of_volume(volume, thickness); }

double ClumpShape::least_contact_mass(double density) const {
  std::vector<Vec3> offsets;
  for (const PlacedSphere& member : members) offsets.push_back(member.position);
  return dem::least_contact_mass(density * volume, density * moments, offsets);
}

double least_contact_mass(double mass, const Vec3& moments, std::span<const Vec3> offsets) {
  double largest = 0.0;
  for (const Vec3& r : offsets) {
    Eigen::Matrix3d cross;
    cross << 0.0, -r[2], r[1], r[2], 0.0, -r[0], -r[1], r[0], 0.0;
    const Eigen::Matrix3d readiness = cross.transpose() * moments.cwiseInverse().asDiagonal() * cross;
    largest = std::max(largest, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(readiness).eigenvalues().maxCoeff());
  }
  return 1.0 / (1.0 / mass + largest);
}

// Members about the centre of mass in the frame of these axes, and the sphere that holds them.
static void move_members(ClumpShape& shape, const Eigen::Matrix3d& axes) {
  for (PlacedSphere& member : shape.members) {
    member.position = axes.transpose() * (member.position - shape.centre);
    shape.bounding_radius = std::max(shape.bounding_radius, member.position.norm() + member.radius);
  }
}

ClumpShape clump_shape(std::span<const PlacedSphere> members, double thickness) {
  check_members(members, thickness);
  const bool disks = thickness > 0.0;
  const BodyMoments body = disks ? union_of_disks(members, thickness) : union_of_spheres(members);
  ClumpShape shape;
  shape.members.assign(members.begin(), members.end());
  shape.volume = body.volume;
  shape.centre = body.centre;
  shape.thickness = thickness;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  if (disks) {
    // Disks turn about y alone, and whatever has this axis and this moment turns alike.
    shape.centre[1] = members.front().position[1];
    shape.moments = Vec3::Constant(body.inertia(1, 1));
  } else {
    axes = principal_axes(body.inertia);
    shape.moments = (axes.transpose() * body.inertia * axes).diagonal();
    const Eigen::Quaterniond q(axes);
    shape.principal = normalised({q.w(), q.x(), q.y(), q.z()});
  }
  move_members(shape, axes);
  return shape;
}

ClumpShape clump_shape(std::span<const PlacedSphere> members, const BodyMoments& body) {
  check_members(members, 0.0);
  if (!(body.volume > 0.0) || !body.centre.allFinite() || !body.inertia.allFinite())
    throw InputError(
        fmt::format("The body of a clump has a volume of {:g} m^3 and a centre or an inertia; all must be "
                    "finite, and the volume positive.",
                    body.volume));
  const Eigen::Matrix3d axes = principal_axes(body.inertia);
  ClumpShape shape;
  shape.members.assign(members.begin(), members.end());
  shape.volume = body.volume;
  shape.centre = body.centre;
  shape.moments = (axes.transpose() * body.inertia * axes).diagonal();
  constexpr double rounding = 1e-9;
  if (!(shape.moments.minCoeff() > 0.0) || 2.0 * shape.moments.maxCoeff() > (1.0 + rounding) * shape.moments.sum())
    throw InputError(fmt::format(
        "The body of a clump has the principal moments {:g}, {:g} and {:g} m^5; they must be positive, and none may "
        "exceed the sum of the others.",
        shape.moments[0], shape.moments[1], shape.moments[2]));
  const Eigen::Quaterniond q(axes);
  shape.principal = normalised({q.w(), q.x(), q.y(), q.z()});
  move_members(shape, axes);
  return shape;
}

ClumpShape scaled(ClumpShape shape, double factor) {
  const double of_volume = shape.thickness > 0.0 ? factor * factor : factor * factor * factor;
  for (PlacedSphere& member : shape.members) {
    member.position *= factor;
    member.radius *= factor;
  }
  shape.volume *= of_volume;
  shape.moments *= of_volume * factor * factor;
  shape.centre *= factor;
  shape.bounding_radius *= factor;
  return shape;
}

std::vector<GrainSeed> with_members(std::vector<GrainSeed> grains, std::span<const ClumpSeed> clumps,
                                    const PeriodicBox& box) {
  for (const ClumpSeed& clump : clumps) {
    const Eigen::Matrix3d turn = rotation_matrix(clump.principal_orientation());
    const double least_mass = clump.shape->least_contact_mass(clump.density);
    GlobalId id = clump.id;
    for (const PlacedSphere& member : clump.shape->members) {
      const Vec3 arm = turn * member.position;
      GrainSeed seed;
      seed.id = id++;
      seed.radius = member.radius;
      seed.density = clump.density;
      seed.position = box.wrapped(clump.position + arm);
      seed.velocity = clump.velocity + clump.angular_velocity.cross(arm);
      seed.angular_velocity = clump.angular_velocity;
      seed.material = clump.material;
      seed.motion = member_of(clump.motion);
      seed.thickness = clump.shape->thickness;
      seed.clump = clump.id;
      seed.clump_mass = clump.mass();
      seed.clump_least_mass = least_mass;
      seed.offset = member.position;
      grains.push_back(seed);
    }
  }
  return grains;
}

void check(std::span<const ClumpSeed> clumps, const PeriodicBox& box) {
  for (const ClumpSeed& clump : clumps)
    for (int axis = 0; axis < 3; ++axis) {
      if (!(clump.position[axis] >= 0.0 && clump.position[axis] <= box.size[axis]))
        throw InputError(fmt::format(
            "Clump {} at ({:g}, {:g}, {:g}) m has its centre outside the box; its {} must be between 0 and "
            "{:g} m.",
            clump.id, clump.position[0], clump.position[1], clump.position[2], "xyz"[axis], box.size[axis]));
      const bool in_plane = clump.shape->thickness > 0.0 && axis == 1;
      if (box.periodic[axis] && !in_plane && box.size[axis] < 2.01 * clump.shape->bounding_radius)
        throw InputError(
            fmt::format("The box is {:g} m along its periodic axis {}; it must be longer than clump {}, {:g} m, or the "
                        "clump touches itself.",
                        box.size[axis], "xyz"[axis], clump.id, 2.01 * clump.shape->bounding_radius));
    }
}

}  // namespace thalweg::dem
