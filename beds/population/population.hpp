// Grains of one kind in a case: how many there are, how large, of what shape and density, where they are put and how
// they move; and what follows from it for all of them.
#pragma once

#include "beds/population/material_keys.hpp"
#include "beds/population/placement_keys.hpp"
#include "beds/sizes/size_distribution.hpp"
#include "core/base/types.hpp"
#include "core/keys/section_visitor.hpp"
#include "core/state/bed.hpp"
#include "dem/motion/motion_keys.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace thalweg::beds {

// A sphere of a clump, or a disk.
struct MemberKeys {
  Vec3 position = Vec3::Zero();  // m, from any origin
  double diameter = 0.0;         // m
  bool operator==(const MemberKeys&) const = default;
};

// The body that the spheres of a clump stand for, at 1 kg/m^3.
struct BodyKeys {
  double volume = 0.0;          // m^3
  Vec3 centre = Vec3::Zero();   // m, in the frame of the members
  std::vector<double> inertia;  // m^5, about the centre: xx, yy, zz, xy, xz, yz (core/geometry/symmetric_pairs.hpp)
  bool operator==(const BodyKeys&) const = default;
};

// The shape of grains that are not spheres.
struct ShapeKeys {
  std::vector<MemberKeys> clump;  // made of the surface where there is one
  std::optional<BodyKeys> body;   // none: volume, centre and inertia of the clump's union
  // The surface to make them of; none of these is kept once it is done (take_surface()).
  std::optional<std::string> stl;       // file
  std::optional<double> scale;          // m per unit of the file; else 1
  std::optional<std::int64_t> spheres;  // see ClumpFit
  std::optional<double> tolerance;
  std::string made_from = {};  // the file, absolute; empty: of no surface
  double inscribed = 1.0;      // share of the surface's volume that its spheres held before they grew

  // Whatever they are made from.
  bool operator==(const ShapeKeys& other) const { return clump == other.clump && body == other.body; }
};

// A rotation about an axis from the shape as it is given.
struct OrientationKeys {
  Vec3 axis = Vec3::UnitY();  // of any length
  double angle = 0.0;         // rad
  bool operator==(const OrientationKeys&) const = default;
};

// Fill: the number of grains that makes a settled bed of this depth over the floor of the region, or of the box.
struct FillKeys {
  std::optional<double> depth;     // m
  std::optional<double> layers;    // 1; or the depth in reference diameters
  std::optional<double> porosity;  // 1, of the settled bed; else by settled_fraction() (packing.hpp)
  bool operator==(const FillKeys&) const = default;
};

struct PopulationKeys {
  std::int64_t count = 0;  // completed from positions, the grains of the file, solid fraction or fill, where given
  std::optional<double> solid_fraction;  // of the region; none once the count is completed
  std::optional<FillKeys> fill;          // likewise
  double diameter = 0.0;  // m, of a clump that of the sphere (disk) of its volume, 0: as its shape is given; completed:
                          // where they differ, the one that half of the mass is finer than
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
  std::optional<dem::MotionKeys> motion;            // all together, as one body
  bool operator==(const PopulationKeys&) const = default;

  bool has_size() const { return sizes.given() || diameter > 0.0; }     // its grains, whatever their shape
  bool held() const { return fixed || prescribed_velocity || motion; }  // moves as prescribed, or not at all
};
void describe(SectionVisitor& visit, PopulationKeys& population);

// Figures of the clumps of a population.
struct ClumpFigures {
  std::int64_t count = 0;
  double volume = 0.0;              // m^3, of all
  double least_contact_mass = 0.0;  // kg, the least that a contact of any of them feels
  double largest_extent = 0.0;      // m, diameter of the sphere about its centre that holds the largest
  double shortest_axis = 0.0;       // m, of any of them (clump_axes())
  bool operator==(const ClumpFigures&) const = default;

  void add(const ClumpFigures& more);  // figures of at least one more clump
};

// Figures of all rows taken from a bed file, of which a rank has only its share: the same bits on every rank, and on
// any number of ranks.
struct FileFigures {
  // Sums over the grains, a clump counting with the sphere (disk) of its volume.
  struct Sums {
    double diameter = 0.0, volume = 0.0, mass = 0.0;  // m, m^3, kg; the mass at the density of the population
    bool operator==(const Sums&) const = default;
  };

  std::int64_t rows = 0;           // 0: not from a file
  double smallest_diameter = 0.0;  // m, of grains and members
  double largest_diameter = 0.0;   // m
  double lightest_grain = 0.0;     // kg, of those that are not members
  double least_density = 0.0;      // kg/m^3, of all rows
  double largest_density = 0.0;    // kg/m^3
  double radius_per_mass = 0.0;    // m/kg, the largest of those
  double largest_member = 0.0;     // m, radius
  double volume = 0.0;             // m^3, of all grains
  double fastest = 0.0;            // m/s
  double mean_height = 0.0;        // m, of the rows by their volume
  double height_deviation = 0.0;   // m, about it, of the centres
  std::vector<SizeCount> sizes;    // of the grains, as for the sums
  Sums sums;
  bool operator==(const FileFigures&) const = default;
};

// Population with the properties that follow from sizes, shape and file (population_bed.hpp).
struct Population : PopulationKeys {
  double thickness = 0.0;                  // m, of disks; 0: spheres
  std::vector<double> diameters;           // m, one a grain; empty: all `diameter`, or from a file
  std::optional<double> settled_porosity;  // 1, as its fill says; none: that of settled_fraction() (packing.hpp)
  // This rank's share of the rows of placement.file: grains, and members of clumps one after the other. Their ids count
  // from 0 on through the shares of all ranks.
  std::vector<BedGrain> file;
  FileFigures figures;  // of the whole file
  ClumpFigures clumps;  // of shape or file
  // m, of the shape as it is given: of the sphere (disk) of its volume, and its largest extent.
  double shape_diameter = 0.0, shape_extent = 0.0;

  bool operator==(const Population&) const = default;

  bool from_file() const { return figures.rows > 0; }
  std::int64_t row_count() const;  // number of ids: one for each grain, or for each member of a clump
  // Sizes (m) of grains that are not from a file: the diameter, of a clump that of the sphere (disk) of its volume;
  // the diameter of the sphere that a grain needs at its place; the largest of these.
  double diameter_of(std::size_t grain) const { return diameters.empty() ? diameter : diameters[grain]; }
  double room_of(std::size_t grain) const {
    return shape ? shape_extent * scale_of(diameter_of(grain)) : diameter_of(grain);
  }
  double room_of_all() const { return shape ? clumps.largest_extent : largest_diameter(); }
  // Of the smallest and the largest grain, a clump with the sphere (disk) of its volume; m.
  double finest() const;
  double coarsest() const;
  double scale_of(double grain_diameter) const {  // of the clump of this size (m) over the shape as it is given
    return grain_diameter / shape_diameter;
  }
  std::vector<SizeCount> sizes_of_grains() const;  // a clump with the sphere (disk) of its volume; rising
  double volume_of(double grain_diameter) const;   // m^3, of a sphere, or a disk as thick as they are; m
  double smallest_diameter() const;                // m, of spheres and members
  double largest_diameter() const;                 // m
  double narrowest() const;                        // m, diameter of a sphere or shortest axis of a clump
  double largest_extent() const;                   // m, of spheres and clumps
  double lightest_mass() const;                    // kg, the least that a contact feels
  double radius_per_mass() const;                  // m/kg, the largest, with the mass that a contact feels
  double volume() const;                           // m^3, of all its grains
};

// Throw KeyError where the placement puts grains outside a box of this size (m), and where disks would leave the plane
// x-z.
void check_placement(const Population& population, const Vec3& box_size, bool disks);
void check_for_disks(const Population& population);

}  // namespace thalweg::beds
