#include "driver/bed/bed_flow.hpp"

#include "analysis/bed/bed_height.hpp"
#include "beds/packing/packing.hpp"
#include "core/geometry/hydraulic_radius.hpp"
#include "driver/bed/obstacles.hpp"
#include "driver/bed/reference_grain.hpp"
#include "driver/case/grain_setup.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace thalweg::driver {

namespace {

// m, up to which this volume (m^3, with its pores) fills the room that obstacles leave: A h - O(h).
double filled_height(double volume, const analysis::VolumeBelow& below) {
  const auto room = [&](std::size_t k) {
    return static_cast<double>(k) * below.spacing * below.area - below.obstacle[k];
  };
  std::size_t k = 1;
  while (k + 1 < below.obstacle.size() && room(k) < volume) ++k;
  const double here = room(k) - room(k - 1), left = volume - room(k - 1);
  return (static_cast<double>(k - 1) + (here > 0.0 ? left / here : 1.0)) * below.spacing;
}

// m^3, of obstacles below a height (m).
double obstacles_below(const analysis::VolumeBelow& below, double height) {
  return below.obstacle.back() - analysis::obstacles_above(below, height);
}

// Solid fraction of held grains where no others settle between them: fewer stand apart and are no bed.
constexpr double loosest_held_bed = 0.2;

// How many of bed and top hold the flow.
int surfaces(const Case& c) { return 1 + c.domain.faces[top].drags(); }

bool makes_a_bed(const Case& c, const beds::Population& population) {
  return population.held() || !floats(c, population);
}

// m^3.
double volume_in_the_bed(const Case& c) {
  double volume = 0.0;
  for (const beds::Population& population : c.grains)
    if (makes_a_bed(c, population)) volume += population.volume();
  return volume;
}

// m^3, of the grains that sink.
double volume_that_settles(const Case& c) {
  double volume = 0.0;
  for (const beds::Population& population : c.grains)
    if (!population.held() && !floats(c, population)) volume += population.volume();
  return volume;
}

// m, of the surface as the run measures it; 0 where it is looser than a bed.
double surface_of(const analysis::VolumeBelow& below, double loosest) {
  return bulk_solid_fraction(below) < loosest ? 0.0 : bed_height(below, analysis::thin_layers_a_window / 2);
}

double settled_height(const Case& c, const HeldGrains& held, const SolidsBelow& solids) {
  const PeriodicBox box = grain_box(c);
  const int layers = analysis::thin_layers(box.size.z(), reference_grain(c).diameter);
  const double spacing = box.size.z() / layers, area = box.size.x() * box.size.y();
  const std::vector<double> spheres = analysis::union_below(box, held.obstacles.spheres, layers);
  std::vector<double> filled = solids ? solids(layers) : std::vector<double>(spheres.size(), 0.0);
  const double settles = volume_that_settles(c) / settled_fraction(c);  // m^3, with its pores
  if (settles == 0.0 && held.layers.empty()) return surface_of({spheres, spacing, area, filled}, loosest_bed);
  for (std::size_t k = 0; k < filled.size(); ++k) filled[k] += spheres[k];
  const std::vector<double> stays = held_below(c, held.layers, layers);
  const analysis::VolumeBelow below{stays, spacing, area, filled};
  // Held grains looser than a bed have room for others between them.
  const double floor = held.layers.empty() ? 0.0 : surface_of(below, settles > 0.0 ? loosest_bed : loosest_held_bed);
  if (settles == 0.0) return floor;
  if (floor > 0.0)  // what settles lies on it
    return filled_height(settles + area * floor - obstacles_below(below, floor), below);
  for (std::size_t k = 0; k < filled.size(); ++k) filled[k] += stays[k] / settled_fraction(c);
  return filled_height(settles, below);
}

}  // namespace

bool floats(const Case& c, const beds::Population& grains) {
  return has_fluid(c) && grains.density <= (1.0 + neutral_density) * c.fluid.density;
}

FlowNumbers flow_numbers(const Case& c) {
  FlowNumbers flow;
  if (!has_fluid(c) || c.grains.empty()) return flow;
  const Vec3 gravity = gravity_vector(c.gravity);
  const ReferenceGrain grain = reference_grain(c);
  const double g = gravity.norm(), d = grain.diameter;
  flow.density_ratio = grain.density / c.fluid.density;
  const double excess = flow.density_ratio - 1.0;
  flow.galileo = std::sqrt(std::abs(excess) * g * d * d * d) / c.fluid.kinematic_viscosity;
  if (gravity.z() >= 0.0 || excess <= neutral_density || periodic_axes(c.domain)[2]) return flow;

  flow.slope = gravity.x() / -gravity.z();
  flow.bed_height = settled_height(c);
  flow.depth = c.domain.size.z() - flow.bed_height;
  if (flow.depth <= 0.0 || gravity.x() <= 0.0 || !periodic_axes(c.domain)[0] || c.fluid.mean_velocity || walls_drive(c))
    return flow;
  flow.side_walls = side_walls(c);
  flow.top_drags = c.domain.faces[top].drags();
  flow.hydraulic_radius = hydraulic_radius(c, flow.depth);
  flow.shields_depth = gravity.x() * held_by_the_bed(c, flow.depth) / (excess * g * d);
  flow.shields_hydraulic = gravity.x() * flow.hydraulic_radius / (excess * g * d);
  flow.friction_velocity = std::sqrt(gravity.x() * flow.hydraulic_radius);
  flow.particle_reynolds = flow.friction_velocity * d / c.fluid.kinematic_viscosity;
  return flow;
}

double slope_for(const FlowNumbers& flow, double shields) {
  const double sine = std::sin(std::atan(flow.slope)) / flow.shields_hydraulic * shields;
  return sine < 1.0 ? std::tan(std::asin(sine)) : std::numeric_limits<double>::infinity();
}

double settled_height(const Case& c) {
  if (c.grains.empty() || gravity_vector(c.gravity).z() == 0.0) return 0.0;
  HeldGrains held = held_grains_of(c);
  if (periodic_axes(c.domain)[2]) held.layers.clear();
  const SolidsBelow solids = solids_below(c);
  if (solids || !held.obstacles.spheres.empty() || !held.layers.empty()) return settled_height(c, held, solids);
  const double width = c.disks ? c.disks->thickness : c.domain.size.y();
  return volume_in_the_bed(c) / (settled_fraction(c) * c.domain.size.x() * width);
}

bool drives_flow(const Case& c, int axis) {
  const auto lets_through = [](const coupling::FaceKeys& face) {
    return face.type == lbm::FaceType::periodic || lbm::is_open(face.type);
  };
  const auto low = static_cast<std::size_t>(2 * axis);
  return lets_through(c.domain.faces[low]) && lets_through(c.domain.faces[low + 1]);
}

bool inlet_sets_flow(const Case& c, int axis) {
  const auto low = static_cast<std::size_t>(2 * axis);
  return c.domain.faces[low].type == lbm::FaceType::velocity_inlet ||
         c.domain.faces[low + 1].type == lbm::FaceType::velocity_inlet;
}

double largest_outlet_pressure(const Case& c) {
  double largest = 0.0;
  for (const coupling::FaceKeys& face : c.domain.faces)
    if (face.type == lbm::FaceType::pressure_outlet) largest = std::max(largest, std::abs(face.pressure));
  return largest;
}

int side_walls(const Case& c) { return c.domain.faces[y_low].drags() + c.domain.faces[y_high].drags(); }

bool moves_along_x(const coupling::FaceKeys& face) {
  return face.type == lbm::FaceType::moving && face.velocity.x() != 0.0;
}

bool side_walls_move(const Case& c) {
  return moves_along_x(c.domain.faces[y_low]) || moves_along_x(c.domain.faces[y_high]);
}

bool walls_drive(const Case& c) { return side_walls_move(c) || moves_along_x(c.domain.faces[top]); }

double held_by_the_bed(const Case& c, double depth) { return depth / surfaces(c); }

double hydraulic_radius(const Case& c, double depth) {
  return thalweg::hydraulic_radius(held_by_the_bed(c, depth), c.domain.size.y(), side_walls(c));
}

double depth_of(const Case& c, double hydraulic_radius) {
  const double width = c.domain.size.y(), left = width - side_walls(c) * hydraulic_radius;
  return left > 0.0 ? surfaces(c) * hydraulic_radius * width / left : std::numeric_limits<double>::infinity();
}

double hydraulic_radius_with(const Case& c, double shields) {
  const ReferenceGrain grain = reference_grain(c);
  const Vec3 gravity = gravity_vector(c.gravity);
  const double excess = grain.density / c.fluid.density - 1.0;
  return excess * grain.diameter * shields * gravity.norm() / gravity.x();
}

double box_height(const Case& c, double depth) {
  return c.domain.spacing * std::round((settled_height(c) + depth) / c.domain.spacing);
}

double settled_fraction(const Case& c) {
  if (c.grains.empty()) return beds::settled_bed;
  const double usual = beds::settled_fraction(grain_box(c), reference_grain(c).diameter, c.disks.has_value());
  double solid = 0.0, bed = 0.0;  // m^3
  bool other = false;             // a fill says otherwise
  for (const beds::Population& population : c.grains) {
    if (!makes_a_bed(c, population)) continue;
    const double volume = population.volume();
    solid += volume;
    bed += volume / (population.settled_porosity ? 1.0 - *population.settled_porosity : usual);
    other = other || population.settled_porosity;
  }
  if (other) {  // obstacles are of no fill
    const double obstacles = obstacles_of(c).volume_of_grains;
    solid -= obstacles;
    bed -= obstacles / usual;
  }
  return bed > 0.0 ? solid / bed : usual;
}

}  // namespace thalweg::driver
