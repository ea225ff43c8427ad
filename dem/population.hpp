// Grains of one kind in a case: how many there are, how large, of what shape and density, where they are put and how
// they move; and what follows from it for all of them.
#pragma once

#include "core/bed.hpp"
#include "core/section_visitor.hpp"
#include "core/types.hpp"
#include "dem/grain_sizes.hpp"
#include "dem/material_keys.hpp"
#include "dem/motion_keys.hpp"
#include "dem/placement_keys.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace thalweg::dem {

// A sphere of a clump, or a disk.
struct MemberKeys {
  Vec3 position = Vec3::Zero();  // m, from any origin
  double diameter = 0.0;         // m
  bool operator==(const MemberKeys&) const = default;
};

// What grains are that are no spheres.
struct ShapeKeys {
  std::vector<MemberKeys> clump;
  bool operator==(const ShapeKeys&) const = default;
};

// Turned about the axis from how the shape is given.
struct OrientationKeys {
  Vec3 axis = Vec3::UnitY();  // of any length
  double angle = 0.0;         // rad
  bool operator==(const OrientationKeys&) const = default;
};

// As many grains as make a settled bed of this depth over the floor of the region, or of the box.
struct FillKeys {
  std::optional<double> depth;     // m
  std::optional<double> layers;    // 1; or the depth in reference diameters
  std::optional<double> porosity;  // 1, of the settled bed; else that of settled_bed, or settled_disks (packing.hpp)
  bool operator==(const FillKeys&) const = default;
};

struct PopulationKeys {
  std::int64_t count = 0;  // completed from positions, the grains of the file, solid fraction or fill, where given
  std::optional<double> solid_fraction;  // of the region; none once the count is completed
  std::optional<FillKeys> fill;          // likewise
  double diameter = 0.0;  // m; completed: where they differ, the one that half of the mass is finer than; of the
                          // sphere (disk) of a clump's volume
  double density = 0.0;   // kg/m^3; completed from a file: mass over volume of all its grains
  SizesKeys sizes;
  std::optional<ShapeKeys> shape;
  std::optional<OrientationKeys> orientation;  // of all its clumps; none: each at random
  PlacementKeys placement;
  std::optional<MaterialKeys> contact;
  Vec3 velocity = Vec3::Zero();                     // m/s, at the start
  Vec3 angular_velocity = Vec3::Zero();             // rad/s, at the start
  bool fixed = false;                               // never moves
  std::optional<Vec3> prescribed_velocity;          // m/s, kept whatever the loads
  std::optional<Vec3> prescribed_angular_velocity;  // rad/s
  std::optional<MotionKeys> motion;                 // all together, as one body
  bool operator==(const PopulationKeys&) const = default;

  bool held() const { return fixed || prescribed_velocity || motion; }  // moves as prescribed, or not at all
};
void describe(SectionVisitor& visit, PopulationKeys& population);

// What there is to know of the clumps of a population.
struct ClumpFigures {
  std::int64_t count = 0;
  double volume = 0.0;              // m^3, of all
  double least_contact_mass = 0.0;  // kg, the least that a contact of any of them feels
  double largest_extent = 0.0;      // m, diameter of the sphere about its centre that holds the largest
  bool operator==(const ClumpFigures&) const = default;
};

// With what follows from sizes, shape and file (population_bed.hpp).
struct Population : PopulationKeys {
  double thickness = 0.0;              // m, of disks; 0: spheres
  std::vector<double> diameters;       // m, one a grain or row of the file; empty: all `diameter`
  std::vector<BedGrain> file;          // rows of placement.file: grains, and members of clumps one after the other
  std::vector<double> body_diameters;  // m, of a file: one a grain, of a clump that of the sphere (disk) of its volume
  ClumpFigures clumps;                 // of shape or file

  bool operator==(const Population&) const = default;

  std::int64_t row_count() const;  // ids that its grains take, one each, but one each member of a clump
  // m; of a clump that of the sphere (disk) of its volume
  double body_diameter_of(std::size_t body) const { return file.empty() ? diameter_of(body) : body_diameters[body]; }
  double diameter_of(std::size_t grain) const { return diameters.empty() ? diameter : diameters[grain]; }
  // m, of the sphere that a grain of its own, not from a file, needs where it is put
  double room_of(std::size_t grain) const { return shape ? clumps.largest_extent : diameter_of(grain); }
  double room_of_all() const { return shape ? clumps.largest_extent : largest_diameter(); }  // the same of the largest
  double density_of(std::size_t grain) const { return file.empty() ? density : file[grain].density; }
  double smallest_diameter() const;  // m, of spheres and members
  double largest_diameter() const;   // m
  double largest_extent() const;     // m, of spheres and clumps
  double lightest_mass() const;      // kg, the least that a contact feels
  double volume() const;             // m^3, of all its grains
};

// Throw KeyError: whether it stays in a box of this size (m) where its placement puts it, and whether disks stay in the
// plane x-z.
void check_placement(const Population& population, const Vec3& box_size, bool disks);
void check_for_disks(const Population& population);

}  // namespace thalweg::dem
