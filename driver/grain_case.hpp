// The grains of a case as the user asked for them, in SI units: populations, where they are put, what they are made of.
#pragma once

#include "core/types.hpp"
#include "dem/contact_parameters.hpp"
#include "io/bed_file.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace thalweg {

// On top of a velocity: amplitude [sin(2 pi frequency t + phase) - sin(phase)].
struct OscillationCase {
  Vec3 amplitude = Vec3::Zero();  // m
  double frequency = 0.0;         // Hz
  double phase = 0.0;             // rad
  bool operator==(const OscillationCase&) const = default;
};

struct RotationCase {
  Vec3 point = Vec3::Zero();      // m, on the axis, at the start
  Vec3 axis = Vec3::UnitY();      // any length but zero
  double angular_velocity = 0.0;  // rad/s
  bool operator==(const RotationCase&) const = default;
};

// Of a population that moves as one rigid body.
struct MotionCase {
  Vec3 velocity = Vec3::Zero();  // m/s
  std::optional<OscillationCase> oscillation;
  std::optional<RotationCase> rotation;  // about an axis that moves along
  bool operator==(const MotionCase&) const = default;
};

// What makes a wall a plate around its point, with two sides and edges.
struct PlateCase {
  Vec3 along = Vec3::UnitX();  // in the plane of the wall; any length but zero
  double length = 0.0;         // m, along it
  double width = 0.0;          // m, across it
  bool operator==(const PlateCase&) const = default;
};

// A plane wall besides the faces of the box, or a plate.
struct WallCase {
  Vec3 point = Vec3::Zero();               // m
  Vec3 normal = Vec3::UnitZ();             // into the side of the grains; any length but zero
  std::optional<double> friction;          // else contact.wall_friction
  std::optional<double> rolling_friction;  // else contact.wall_rolling_friction
  Vec3 velocity = Vec3::Zero();            // m/s
  std::optional<OscillationCase> oscillation;
  std::optional<PlateCase> plate;
  bool operator==(const WallCase&) const = default;
};

enum class PlacementPattern { uniform, random };

struct RegionCase {
  Vec3 lower = Vec3::Zero();  // m
  Vec3 upper = Vec3::Zero();  // m
  bool operator==(const RegionCase&) const = default;
};

enum class FileVelocities { kept, zero };

struct PlacementCase {
  static constexpr double bed_overlap = 0.01;

  PlacementPattern pattern = PlacementPattern::uniform;  // unless there are positions or a file
  std::int64_t seed = 1;
  std::optional<RegionCase> region;          // none: the whole box; of a file: the grains with their centre in it
  std::vector<Vec3> positions;               // m; as many as the population counts, or none
  std::optional<std::string> file;           // a bed file; relative to the case file, absolute once read
  std::optional<double> largest_overlap;     // diameters the grains of the file may overlap by; else bed_overlap
  std::optional<FileVelocities> velocities;  // of the file; else kept
  bool operator==(const PlacementCase&) const = default;
};

enum class SizeDistribution { lognormal };

// How the diameters of a population differ; nothing given: not at all.
struct SizesCase {
  std::optional<SizeDistribution> distribution;
  std::optional<double> median;               // m, by number, before the tails are cut
  std::optional<double> geometric_deviation;  // 1; exp of the standard deviation of ln d
  std::optional<double> minimum, maximum;     // m, where the tails are cut
  std::vector<double> sizes;                  // m, in place of a distribution
  std::vector<double> fractions;              // of the number of grains, as many as sizes
  bool operator==(const SizesCase&) const = default;

  bool given() const { return distribution || !sizes.empty(); }
};

// What a population or the walls are made of, where it differs from the section `contact`.
struct MaterialCase {
  std::optional<double> normal_stiffness;      // N/m
  std::optional<double> tangential_stiffness;  // N/m
  std::optional<double> youngs_modulus;        // Pa
  std::optional<double> poisson_ratio;         // 1
  std::optional<double> restitution;           // 1
  std::optional<double> damping;               // kg/s
  std::optional<double> friction;              // 1; not of walls, whose friction is contact.wall_friction
  std::optional<double> rolling_friction;      // 1; likewise
  bool operator==(const MaterialCase&) const = default;
};

struct WallMaterialCase : MaterialCase {
  bool operator==(const WallMaterialCase&) const = default;
};

// A sphere of a clump, or a disk.
struct MemberCase {
  Vec3 position = Vec3::Zero();  // m, from any origin
  double diameter = 0.0;         // m
  bool operator==(const MemberCase&) const = default;
};

// What grains are that are no spheres.
struct ShapeCase {
  std::vector<MemberCase> clump;
  bool operator==(const ShapeCase&) const = default;
};

// Turned about the axis from how the shape is given.
struct OrientationCase {
  Vec3 axis = Vec3::UnitY();  // of any length
  double angle = 0.0;         // rad
  bool operator==(const OrientationCase&) const = default;
};

// What there is to know of the clumps of a population.
struct ClumpFigures {
  std::int64_t count = 0;
  double volume = 0.0;              // m^3, of all
  double least_contact_mass = 0.0;  // kg, the least that a contact of any of them feels
  double largest_extent = 0.0;      // m, diameter of the sphere about its centre that holds the largest
  bool operator==(const ClumpFigures&) const = default;
};

struct PopulationCase {
  std::int64_t count = 0;  // read as the number of positions, or of grains in the file, where those are given
  double diameter = 0.0;   // m; where they differ, the one that half of the mass is finer than; of the sphere of a
                           // clump's volume
  double density = 0.0;    // kg/m^3; from a file: mass over volume of all its grains
  SizesCase sizes;
  std::optional<ShapeCase> shape;
  std::optional<OrientationCase> orientation;  // of all its clumps; none: each at random
  PlacementCase placement;
  std::optional<MaterialCase> contact;
  Vec3 velocity = Vec3::Zero();                     // m/s, at the start
  Vec3 angular_velocity = Vec3::Zero();             // rad/s, at the start
  bool fixed = false;                               // never moves
  std::optional<Vec3> prescribed_velocity;          // m/s, kept whatever the loads
  std::optional<Vec3> prescribed_angular_velocity;  // rad/s
  std::optional<MotionCase> motion;                 // all together, as one body

  // What read_case() makes of disks, sizes and file.
  double thickness = 0.0;              // m, of disks; 0: spheres
  std::vector<double> diameters;       // m, one a grain or row of the file; empty: all `diameter`
  std::vector<io::BedGrain> file;      // rows of placement.file: grains, and members of clumps one after the other
  std::vector<double> body_diameters;  // m, of a file: one a grain, of a clump that of the sphere of its volume
  ClumpFigures clumps;                 // of shape or file

  bool operator==(const PopulationCase&) const = default;

  std::int64_t row_count() const;  // ids that its grains take, one each, but one each member of a clump
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

// The diameter that half of the mass of these grains is finer than; m.
double median_by_volume(std::vector<double> diameters);

// One diameter (m) a grain. Every grain takes the place in the distribution that its random number has among those of
// the population, so that the population follows the distribution as closely as its number allows, and the seed only
// shuffles. fractions: each size gets its share of the number, rounded so that the sum is right.
std::vector<double> sampled_diameters(const SizesCase& sizes, std::int64_t count, std::int64_t seed);

// Of grains and of what is not said otherwise.
struct ContactCase : dem::ContactParameters {
  ContactCase() {
    normal_stiffness = 20000.0;
    tangential_stiffness = 5714.0;
    poisson_ratio = 0.3;
    friction = 0.5;
    wall_friction = 0.45;
    attraction = true;
  }
  std::optional<WallMaterialCase> walls;  // contact of grains with walls, where it differs
  bool operator==(const ContactCase&) const = default;
};

}  // namespace thalweg
