#include "driver/bed/obstacles.hpp"

#include "beds/population_seeds.hpp"
#include "core/geometry/mesh_volume.hpp"
#include "core/geometry/periodic_box.hpp"
#include "driver/case/grain_setup.hpp"
#include "driver/case/solid_setup.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <numbers>
#include <numeric>
#include <utility>

namespace thalweg::driver {

namespace {

constexpr double merged = 0.05;        // diameters of the smaller, of an overlap that makes one body of two grains
constexpr double as_long_again = 2.0;  // times the longest free grain

// A sphere or clump.
struct HeldGrain {
  double volume, extent, height;               // m^3, m, m of its centre
  std::vector<analysis::SphereInBed> spheres;  // one, or its members
  bool stands = false;                         // is an obstacle
};

// first: id of the population's first.
std::vector<HeldGrain> held_grains(const beds::Population& population, const PeriodicBox& box, GlobalId first) {
  dem::GrainSeeds start = beds::grain_seeds(std::span(&population, 1), beds::PackingDomain(box));
  const std::vector<dem::GrainSeed> rows = dem::with_members(std::move(start.grains), start.clumps, box);
  std::vector<HeldGrain> grains(static_cast<std::size_t>(population.count));
  const auto members = static_cast<std::size_t>(population.row_count() / std::max<std::int64_t>(1, population.count));
  for (std::size_t n = 0; n < grains.size(); ++n) {
    grains[n].volume = population.volume_of(population.diameter_of(n));
    grains[n].extent = population.room_of(n);
    grains[n].height = population.placement.positions[n].z();
  }
  for (const dem::GrainSeed& row : rows)
    grains[static_cast<std::size_t>(row.id) / members].spheres.push_back(
        {first + row.id, {row.position.x(), row.position.y(), row.position.z()}, row.radius});
  return grains;
}

std::vector<HeldGrain> all_held_grains(const Case& c) {
  std::vector<HeldGrain> all;
  GlobalId first = 0;
  for (const beds::Population& population : c.grains) {
    if (population.held() && !population.placement.positions.empty())
      for (HeldGrain& grain : held_grains(population, grain_box(c), first)) all.push_back(std::move(grain));
    first += population.row_count();
  }
  return all;
}

bool are_merged(const PeriodicBox& box, const analysis::SphereInBed& a, const analysis::SphereInBed& b) {
  const double reach = a.radius + b.radius - merged * 2.0 * std::min(a.radius, b.radius);
  const Vec3 apart(a.centre[0] - b.centre[0], a.centre[1] - b.centre[1], a.centre[2] - b.centre[2]);
  return box.difference(apart, Vec3::Zero()).squaredNorm() < reach * reach;
}

// Marks grains whose spheres overlap as merged; neighbours are searched along x.
void mark_merged(const PeriodicBox& box, std::vector<HeldGrain>& grains) {
  struct Entry {
    double x;
    std::size_t grain;
    const analysis::SphereInBed* sphere;
  };
  std::vector<Entry> along;
  double largest = 0.0;
  for (std::size_t g = 0; g < grains.size(); ++g)
    for (const analysis::SphereInBed& sphere : grains[g].spheres) {
      largest = std::max(largest, sphere.radius);
      for (const double image : {-box.size.x(), 0.0})  // one to the left, so that neighbours through the face are met
        if (image == 0.0 || box.periodic[0]) along.push_back({sphere.centre[0] + image, g, &sphere});
    }
  std::sort(along.begin(), along.end(), [](const Entry& a, const Entry& b) { return a.x < b.x; });
  for (std::size_t n = 0; n < along.size(); ++n)
    for (std::size_t m = n + 1; m < along.size() && along[m].x - along[n].x < 2.0 * largest; ++m) {
      HeldGrain &a = grains[along[n].grain], &b = grains[along[m].grain];
      if (along[n].grain == along[m].grain || (a.stands && b.stands)) continue;
      if (are_merged(box, *along[n].sphere, *along[m].sphere)) a.stands = b.stands = true;
    }
}

// Those with positions; `stands` is set.
std::vector<HeldGrain> held_with_positions(const Case& c) {
  std::vector<HeldGrain> grains = all_held_grains(c);
  mark_merged(grain_box(c), grains);
  const double longest = longest_free_grain(c);
  for (HeldGrain& grain : grains)
    if (longest > 0.0 && grain.extent >= (1.0 - whole_number_tolerance) * as_long_again * longest) grain.stands = true;
  return grains;
}

// Of a held population without positions.
HeldLayer layer_of(const Case& c, const beds::Population& population) {
  const double diameter = population.diameter, volume = population.volume();
  if (population.from_file()) {  // of a slab the variance is a twelfth of its thickness squared; of a sphere d^2/20
    const double deviation = population.figures.height_deviation, middle = population.figures.mean_height;
    const double half = std::sqrt(3.0 * (deviation * deviation + diameter * diameter / 20.0));
    return {middle - half, middle + half, diameter, volume};
  }
  const beds::RegionKeys region = region_of(c, population);
  return {region.lower.z(), region.upper.z(), diameter, volume};
}

// Adds a sheet of spheres of this volume (m^3) with their centres at this height (m) to the volumes in layers, that
// below level k at k.
void add_sheet(double centre, double diameter, double volume, double spacing, std::vector<double>& layers) {
  const auto share = [&](double height) {  // of a sphere, below this height
    const double part = std::clamp((height - centre) / diameter + 0.5, 0.0, 1.0);
    return part * part * (3.0 - 2.0 * part);
  };
  const double lowest = std::clamp((centre - 0.5 * diameter) / spacing, 0.0, static_cast<double>(layers.size()));
  const auto first = static_cast<std::size_t>(lowest);
  double before = share(static_cast<double>(first) * spacing);
  for (std::size_t k = first + 1; k < layers.size() && before < 1.0; ++k) {
    const double now = share(static_cast<double>(k) * spacing);
    layers[k] += volume * (now - before);
    before = now;
  }
}

// volume_below(), which takes a twentieth of a second. Keeps the last answers: the estimates of a case ask for the same
// ones a hundred times.
std::vector<double> kept_volume_below(const std::vector<TriangleMesh>& surfaces, const PeriodicBox& box, int layers) {
  struct Answer {
    std::vector<TriangleMesh> surfaces;
    PeriodicBox box;
    int layers;
    std::vector<double> volumes;
  };
  static std::deque<Answer> answers;
  constexpr std::size_t most_answers = 8;
  const auto known = std::find_if(answers.begin(), answers.end(), [&](const Answer& answer) {
    return answer.layers == layers && answer.box.size == box.size && answer.box.periodic == box.periodic &&
           answer.surfaces == surfaces;
  });
  if (known != answers.end()) return known->volumes;
  if (answers.size() == most_answers) answers.pop_front();
  answers.push_back({surfaces, box, layers, volume_below(surfaces, box, layers)});
  return answers.back().volumes;
}

}  // namespace

double longest_free_grain(const Case& c) {
  double longest = 0.0;
  for (const beds::Population& population : c.grains)
    if (!population.held()) longest = std::max(longest, population.largest_extent());
  return longest;
}

HeldGrains held_grains_of(const Case& c) {
  HeldGrains found;
  if (c.disks) return found;
  for (const HeldGrain& grain : held_with_positions(c)) {
    if (grain.stands) {
      found.obstacles.volume_of_grains += grain.volume;
      found.obstacles.spheres.insert(found.obstacles.spheres.end(), grain.spheres.begin(), grain.spheres.end());
    } else {
      const double diameter = std::cbrt(6.0 / std::numbers::pi * grain.volume);
      found.layers.push_back({grain.height - 0.5 * diameter, grain.height + 0.5 * diameter, diameter, grain.volume});
    }
  }
  for (const beds::Population& population : c.grains)
    if (population.held() && population.placement.positions.empty()) found.layers.push_back(layer_of(c, population));
  return found;
}

Obstacles obstacles_of(const Case& c) { return held_grains_of(c).obstacles; }

std::vector<double> held_below(const Case& c, const std::vector<HeldLayer>& held, int layers) {
  std::vector<double> below(static_cast<std::size_t>(layers) + 1, 0.0);
  const double spacing = c.domain.size.z() / layers;
  for (const HeldLayer& layer : held) {
    const double height = layer.upper - layer.lower;
    const int sheets = std::max(1, static_cast<int>(height / layer.diameter * (1.0 + whole_number_tolerance)));
    for (int n = 0; n < sheets; ++n)
      add_sheet(layer.lower + (n + 0.5) / sheets * height, layer.diameter, layer.volume / sheets, spacing, below);
  }
  std::partial_sum(below.begin(), below.end(), below.begin());
  return below;
}

SolidsBelow solids_below(const Case& c) {
  const auto moves = [](const SolidCase& solid) { return solid.motion.has_value(); };
  if (c.disks || std::all_of(c.solids.begin(), c.solids.end(), moves)) return {};
  std::vector<TriangleMesh> standing = solid_surfaces(c, 0.0);
  for (std::size_t n = c.solids.size(); n-- > 0;)
    if (moves(c.solids[n])) standing.erase(standing.begin() + static_cast<std::ptrdiff_t>(n));
  // Shared by the copies of the function.
  return [surfaces = std::make_shared<const std::vector<TriangleMesh>>(std::move(standing)),
          box = grain_box(c)](int layers) { return kept_volume_below(*surfaces, box, layers); };
}

double solid_volume(const Case& c) {
  const Obstacles obstacles = obstacles_of(c);
  if (obstacles.spheres.empty()) return grain_volume(c);
  return grain_volume(c) - obstacles.volume_of_grains +
         analysis::union_below(grain_box(c), obstacles.spheres, 1).back();
}

}  // namespace thalweg::driver
