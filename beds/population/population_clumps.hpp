// Makes the clumps of clump_seed.hpp from those of a case or a bed file.
#pragma once

#include "beds/population/population.hpp"
#include "core/geometry/periodic_box.hpp"
#include "core/geometry/triangle_mesh.hpp"
#include "core/state/bed.hpp"
#include "dem/clumps/clump_seed.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <vector>

namespace thalweg::beds {

// Shape of the clumps of a population with `shape`. Throws InputError if no clump can be made of it.
std::shared_ptr<const dem::ClumpShape> clump_shape_of(const Population& population);

// The shapes of the clumps of a population by their size, each made when it is first wanted.
class ClumpShapes {
public:
  explicit ClumpShapes(const Population& population);  // throws as clump_shape_of()

  std::size_t member_count() const { return as_given_->members.size(); }
  std::shared_ptr<const dem::ClumpShape> of(double diameter);  // m, of the sphere (disk) of its volume

private:
  std::shared_ptr<const dem::ClumpShape> as_given_;
  std::map<double, std::shared_ptr<const dem::ClumpShape>> by_diameter_;
};

// m, the three axes of the ellipsoid with the clump's moments of inertia (shapes/shape_figures.hpp), rising. The middle
// one decides what sieve a grain passes. Not of disks.
std::array<double, 3> clump_axes(const dem::ClumpShape& shape);

// Makes the clump of `shape` of a surface in m, by its number of spheres and tolerance, and forgets these. Throws
// InputError where none can be made (shapes/mesh_clump.hpp).
void take_surface(ShapeKeys& shape, const TriangleMesh& surface);

// Orientation of one clump of such a population: the given one, or one drawn uniformly from all rotations (K.
// Shoemake, Graphics Gems III (1992) 124; of disks, from those about y). grain: its number in the population.
dem::Quaternion orientation_of(const Population& population, std::size_t grain);

// The grains of a bed file one by one, each either one row or the members of one clump, which follow each other.
std::vector<std::span<const BedGrain>> bodies_of(std::span<const BedGrain> rows);

// The clump that these members make, or that of their body, as it lies and moves, with id 0. box: of the bed.
// thickness: m, of disks. Throws InputError where they make none.
dem::ClumpSeed clump_from(std::span<const BedGrain> members, const PeriodicBox& box, double thickness);

// Figures of `count` clumps of this shape and density (kg/m^3).
ClumpFigures figures_of(const dem::ClumpShape& shape, double density, std::int64_t count);

// Figures of all clumps of a population whose sizes are known, of this shape as it is given.
ClumpFigures figures_of(const Population& population, const dem::ClumpShape& as_given);

}  // namespace thalweg::beds
