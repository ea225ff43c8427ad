// A clump as a run begins with it: a rigid grain made of spheres (or disks) that may overlap. Every member has an id
// and a row in GrainStore like a grain of its own; dem/clumps/clumps.hpp moves them together.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/periodic_box.hpp"
#include "dem/clumps/placed_sphere.hpp"
#include "dem/clumps/rigid_rotation.hpp"
#include "dem/motion/grain_seed.hpp"
#include "dem/motion/grain_store.hpp"

#include <memory>
#include <span>
#include <vector>

namespace thalweg::dem {

struct ClumpShape {
  std::vector<PlacedSphere> members;  // m, about the centre of mass, in the frame of the principal axes
  double volume = 0.0;                // m^3, of the union
  Vec3 moments = Vec3::Zero();        // kg m^2 about the principal axes at 1 kg/m^3; of disks all three the one about y
  Vec3 centre = Vec3::Zero();         // m, centre of mass in the frame the members were given in
  Quaternion principal;               // from the frame of the principal axes to the one given
  double bounding_radius = 0.0;       // m: of the sphere about the centre that holds all members
  double thickness = 0.0;             // m, of disks in the plane x-z; 0: spheres

  double equivalent_radius() const;  // m, of the sphere (disk) of the same volume

  double least_contact_mass(double density) const;  // kg, see below
};

// The least mass (kg) a contact of a rigid body feels: 1/m = 1/M + (r x n).I^-1 (r x n), the least over its members (at
// offsets r from the centre, m, in the frame of the principal axes) and all normals n, since the force of a contact
// points through a member's centre.
double least_contact_mass(double mass, const Vec3& moments, std::span<const Vec3> offsets);

// members: positions in any frame. Throws InputError where there are none, a radius is not positive, or disks (with a
// thickness) are not in one plane y = const.
ClumpShape clump_shape(std::span<const PlacedSphere> members, double thickness = 0.0);

// The shape `factor` times as large; disks keep their thickness.
ClumpShape scaled(ClumpShape shape, double factor);

struct ClumpSeed {
  GlobalId id = 0;                          // of its first member; the others have those that follow
  std::shared_ptr<const ClumpShape> shape;  // may be shared by many
  double density = 0.0;                     // kg/m^3
  Vec3 position = Vec3::Zero();             // m, of the centre of mass
  Quaternion orientation;                   // of the frame the members were given in
  Vec3 velocity = Vec3::Zero();             // m/s, of the centre of mass
  Vec3 angular_velocity = Vec3::Zero();     // rad/s
  int material = 0;                         // number of its material
  Motion motion = Motion::free;             // held components keep the velocities above

  double mass() const { return density * shape->volume; }  // kg
  Quaternion principal_orientation() const { return normalised(product(orientation, shape->principal)); }
};

// Grains and clumps at the start of a run.
struct GrainSeeds {
  std::vector<GrainSeed> grains;
  std::vector<ClumpSeed> clumps;  // whose members have ids of their own
  // True: the full lists, the same on every rank. False: the bodies whose centres this rank owns, all that may touch
  // them, and all members of rigid assemblies.
  bool whole = true;
};

// The grains, and after them the members of the clumps as grains.
std::vector<GrainSeed> with_members(std::vector<GrainSeed> grains, std::span<const ClumpSeed> clumps,
                                    const PeriodicBox& box);

// Throws InputError naming the first clump whose centre is outside the box or that could touch itself through a
// periodic face; what else there is to check is checked of its members (grain_seed.hpp).
void check(std::span<const ClumpSeed> clumps, const PeriodicBox& box);

}  // namespace thalweg::dem
