#include "driver/estimate/bed_flow.hpp"

#include "analysis/bed/bed_height.hpp"
#include "beds/packing/packing.hpp"
#include "core/geometry/hydraulic_radius.hpp"
#include "driver/case/grain_setup.hpp"
#include "driver/estimate/obstacles.hpp"
#include "driver/estimate/reference_grain.hpp"

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

double settled_height(const Case& c, const Obstacles& obstacles, const SolidsBelow& solids) {
  const PeriodicBox box = grain_box(c);
  const int layers = analysis::thin_layers(box.size.z(), reference_grain(c).diameter);
  std::vector<double> spheres = analysis::union_below(box, obstacles.spheres, layers);
  std::vector<double> filled = solids ? solids(layers) : std::vector<double>(spheres.size(), 0.0);
  const double grains = volume_in_the_bed(c) - obstacles.volume_of_grains;
  analysis::VolumeBelow below{spheres, box.size.z() / layers, box.size.x() * box.size.y(), filled};
  constexpr double rounding = 1e-9;
  if (grains <= rounding * obstacles.volume_of_grains)
    return bulk_solid_fraction(below) < loosest_bed ? 0.0 : bed_height(below, analysis::thin_layers_a_window / 2);
  for (std::size_t k = 0; k < filled.size(); ++k) filled[k] += spheres[k];
  return filled_height(grains / settled_fraction(c), below);
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
  const Obstacles obstacles = obstacles_of(c);
  const SolidsBelow solids = solids_below(c);
  if (solids || !obstacles.spheres.empty()) return settled_height(c, obstacles, solids);
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
