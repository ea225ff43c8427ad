#include "beds/files/bed_import.hpp"

#include "beds/population/population_clumps.hpp"
#include "dem/motion/grain_volume.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

namespace thalweg::beds {
namespace {

// Disks are in the middle of the box along y, wherever the file has them.
bool inside(const Vec3& point, const RegionKeys& region, bool disks) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(disks && axis == 1) && !(point[axis] >= region.lower[axis] && point[axis] <= region.upper[axis]))
      return false;
  return true;
}

// A grain of the file, or a clump.
struct Body {
  double diameter;     // m, of a clump that of the sphere (disk) of its volume
  double volume;       // m^3
  double density;      // kg/m^3
  ClumpFigures clump;  // of a grain: none
};

// The one that these rows make; none: its centre is outside the region of the placement.
std::optional<Body> body_of(std::span<const BedGrain> rows, const Population& population, const PeriodicBox& box) {
  const std::optional<RegionKeys>& region = population.placement.region;
  const bool disks = population.thickness > 0.0;
  const BedGrain& first = rows.front();
  if (first.clump < 0) {
    if (region && !inside(first.position, *region, disks)) return std::nullopt;
    return Body{2.0 * first.radius, dem::grain_volume(first.radius, population.thickness), first.density, {}};
  }
  const dem::ClumpSeed clump = clump_from(rows, box, population.thickness);
  if (region && !inside(clump.position, *region, disks)) return std::nullopt;
  return Body{2.0 * clump.shape->equivalent_radius(), clump.shape->volume, first.density,
              figures_of(*clump.shape, clump.density, 1)};
}

// Takes over the rows in the region.
std::vector<Body> take_bodies(Population& population, std::vector<BedGrain> rows, const PeriodicBox& box) {
  std::vector<Body> bodies;
  std::size_t taken = 0;
  for (const std::span<const BedGrain> of_body : bodies_of(rows)) {
    const std::optional<Body> body = body_of(of_body, population, box);
    if (!body) continue;
    bodies.push_back(*body);
    const auto first = static_cast<std::size_t>(of_body.data() - rows.data());
    for (std::size_t n = 0; n < of_body.size(); ++n) rows[taken++] = rows[first + n];
  }
  rows.resize(taken);
  population.file = std::move(rows);
  return bodies;
}

std::vector<SizeCount> sizes_of(const std::vector<Body>& bodies, const Ranks& ranks) {
  std::vector<double> diameters;
  diameters.reserve(bodies.size());
  for (const Body& body : bodies) diameters.push_back(body.diameter);
  return merged(ranks.gathered(counted(std::move(diameters))));
}

// Extremes of all rows.
void take_extremes(const Population& population, const Ranks& ranks, FileFigures& figures) {
  double smallest = std::numeric_limits<double>::infinity(), largest = 0.0, fastest = 0.0;
  double lightest = std::numeric_limits<double>::max(), radius_per_mass = 0.0, largest_member = 0.0;
  double least_density = lightest, largest_density = 0.0;
  for (const BedGrain& row : population.file) {
    smallest = std::min(smallest, 2.0 * row.radius);
    largest = std::max(largest, 2.0 * row.radius);
    fastest = std::max(fastest, row.velocity.norm());
    least_density = std::min(least_density, row.density);
    largest_density = std::max(largest_density, row.density);
    if (row.clump >= 0) {
      largest_member = std::max(largest_member, row.radius);
      continue;
    }
    const double mass = row.density * population.volume_of(2.0 * row.radius);
    lightest = std::min(lightest, mass);
    radius_per_mass = std::max(radius_per_mass, row.radius / mass);
  }
  figures.smallest_diameter = ranks.smallest(smallest);
  figures.largest_diameter = ranks.largest(largest);
  figures.fastest = ranks.largest(fastest);
  figures.lightest_grain = ranks.smallest(lightest);
  figures.least_density = ranks.smallest(least_density);
  figures.largest_density = ranks.largest(largest_density);
  figures.radius_per_mass = ranks.largest(radius_per_mass);
  figures.largest_member = ranks.largest(largest_member);
}

// Sums in the order of the rows.
struct BodySums {
  std::int64_t count = 0;
  double mass = 0.0, volume = 0.0;  // kg, m^3
  ClumpFigures clumps;
};

BodySums sums_of(const std::vector<Body>& bodies, const Ranks& ranks) {
  return ranks.passed_on<BodySums>({}, [&](BodySums& sums) {
    for (const Body& body : bodies) {
      ++sums.count;
      sums.volume += body.volume;
      sums.mass += body.density * body.volume;
      if (body.clump.count > 0) sums.clumps.add(body.clump);
    }
  });
}

// The sums that need the density of the population.
void take_sums(const Population& population, const std::vector<Body>& bodies, const Ranks& ranks,
               FileFigures& figures) {
  figures.sums = ranks.passed_on<FileFigures::Sums>({}, [&](FileFigures::Sums& sums) {
    for (const Body& body : bodies) {
      const double volume = dem::grain_volume(0.5 * body.diameter, population.thickness);
      sums.diameter += body.diameter;
      sums.volume += volume;
      sums.mass += population.density * volume;
    }
  });
  figures.volume = ranks.passed_on<double>(population.clumps.volume, [&](double& volume) {
    for (const BedGrain& row : population.file)
      if (row.clump < 0) volume += population.volume_of(2.0 * row.radius);
  });
}

// Mean and deviation of the heights, of which a thick bed far above the floor keeps the digits that matter.
void take_heights(const Population& population, const Ranks& ranks, FileFigures& figures) {
  struct Moments {
    double volume = 0.0, first = 0.0, second = 0.0;  // m^3, m^4, m^5
  };
  const Moments moments = ranks.passed_on<Moments>({}, [&](Moments& sums) {
    for (const BedGrain& row : population.file) {
      const double volume = population.volume_of(2.0 * row.radius), height = row.position.z();
      sums.volume += volume;
      sums.first += volume * height;
      sums.second += volume * height * height;
    }
  });
  figures.mean_height = moments.first / moments.volume;
  figures.height_deviation =
      std::sqrt(std::max(0.0, moments.second / moments.volume - figures.mean_height * figures.mean_height));
}

}  // namespace

void take_rows(Population& population, std::vector<BedGrain> rows, const PeriodicBox& box, const Ranks& ranks) {
  std::vector<Body> bodies;
  ranks.on_all([&] { bodies = take_bodies(population, std::move(rows), box); });
  FileFigures& figures = population.figures;
  figures = {};
  figures.rows = ranks.range_of(static_cast<std::int64_t>(population.file.size())).count;
  if (figures.rows == 0) return;
  take_extremes(population, ranks, figures);
  take_heights(population, ranks, figures);
  figures.sizes = sizes_of(bodies, ranks);
  const BodySums sums = sums_of(bodies, ranks);
  population.clumps = sums.clumps;
  population.count = sums.count;
  population.density = sums.mass / sums.volume;
  population.diameter = median_by_mass(figures.sizes, population.thickness > 0.0);
  take_sums(population, bodies, ranks, figures);
}

}  // namespace thalweg::beds
