// A grain as a run begins with it.
#pragma once

#include "core/base/types.hpp"
#include "core/geometry/periodic_box.hpp"
#include "dem/motion/grain_store.hpp"
#include "dem/motion/walls.hpp"

#include <optional>
#include <span>
#include <string>

namespace thalweg::dem {

struct GrainSeed {
  GlobalId id = 0;                       // 0 .. number of grains - 1, each once
  double radius = 0.0;                   // m
  double density = 0.0;                  // kg/m^3
  Vec3 position = Vec3::Zero();          // m
  Vec3 velocity = Vec3::Zero();          // m/s
  Vec3 angular_velocity = Vec3::Zero();  // rad/s
  int material = 0;                      // number of its material
  Motion motion = Motion::free;          // held components keep the velocities above

  int assembly = -1;  // number of the rigid assembly it belongs to (assemblies.hpp); -1: none

  double thickness = 0.0;  // m, of a disk in the x-z plane; 0: a sphere

  // Members of clumps only, filled in by with_members() of clump_seed.hpp.
  GlobalId clump = -1;            // its id; -1: the grain is one of its own
  double clump_mass = 0.0;        // kg
  double clump_least_mass = 0.0;  // kg, the least that its contacts feel
  Vec3 offset = Vec3::Zero();     // m, from the clump's centre in the frame of its principal axes

  double mass() const;          // kg, of the full sphere or disk; of a member that of the clump
  double contact_mass() const;  // kg, the least that a contact feels
};

// Overlap at the start, in diameters of the smaller grain, that is put down to rounding.
inline constexpr double allowed_initial_overlap = 1e-6;

// Throws InputError naming the first grain (by id) with an id out of place, a radius or density that is not positive, a
// centre outside the box, or an overlap with a wall or another grain of more than `allowed_overlap` diameters of the
// smaller; also disks among spheres, and disks that are not all in one plane or move or turn out of it. Fixed grains
// may reach into walls and into each other, and so may members of one clump. A periodic axis must be at least two of
// the largest diameters long, and plates short enough for check_images().
void check(std::span<const GrainSeed> seeds, const PeriodicBox& box, std::span<const Plane> walls,
           double allowed_overlap = allowed_initial_overlap);

// Checks a part of the grains, with any ids. largest_radius: m, of all grains.
void check_part(std::span<const GrainSeed> seeds, const PeriodicBox& box, std::span<const Plane> walls,
                double allowed_overlap, double largest_radius);

// Parts of check(), which throw InputError: what concerns a single grain; a disk against the first of all grains; the
// box. disks: the grains are disks.
void check_alone(const GrainSeed& seed, const PeriodicBox& box, std::span<const Plane> walls, double allowed_overlap);
void check_disk(const GrainSeed& seed, const GrainSeed& first);
void check_periodic_axes(const PeriodicBox& box, double largest_radius, bool disks);

// Two grains that overlap too much, and the message that says so.
struct Overlap {
  GlobalId first, second;
  std::string text;
};

// The pair of lowest ids whose overlap check_part() refuses, if any. Seeds must pass its other checks.
std::optional<Overlap> first_overlap(std::span<const GrainSeed> seeds, const PeriodicBox& box, double allowed_overlap,
                                     double largest_radius);

}  // namespace thalweg::dem
