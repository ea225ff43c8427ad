#include "dem/lubrication.hpp"

#include "core/error.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace thalweg::dem {

namespace {

constexpr double largest_damping_a_step = 0.5;

// Force on the first body, and the couple on it beyond the moment of that force.
struct LubricationLoad {
  Vec3 force, couple;
};

// normal: unit, from the second to the first; sliding: of the first surface against the second; both spins against each
// other.
LubricationLoad load_of(const LubricationResistance& resistance, const Vec3& normal, const Vec3& approach,
                        const Vec3& surface_velocity, const Vec3& spin) {
  const Vec3 sliding = surface_velocity - surface_velocity.dot(normal) * normal;
  const Vec3 rolling = spin - spin.dot(normal) * normal;
  return {-resistance.normal * approach.dot(normal) * normal - resistance.sliding * sliding +
              resistance.mixed * rolling.cross(normal),
          resistance.mixed * normal.cross(sliding) - resistance.rolling * rolling};
}

void add_to_pair(MovingGrain& first, MovingGrain& second, const Vec3& separation,
                 const LubricationParameters& parameters) {
  const double reach = first.position[3] + second.position[3] + parameters.reach();
  const double square = separation.squaredNorm();
  if (square >= reach * reach) return;
  const double distance = std::sqrt(square), gap = distance - first.position[3] - second.position[3];
  if (!(gap > 0.0)) return;
  const Vec3 normal = separation / distance;
  const double first_arm = first.position[3] + 0.5 * gap, second_arm = second.position[3] + 0.5 * gap;
  const Vec3 approach = vector_of(first.velocity - second.velocity);
  const Vec3 spin = vector_of(first_arm * first.spin + second_arm * second.spin);
  const LubricationLoad load =
      load_of(lubrication_resistance(parameters, first.position[3], first.position[3] / second.position[3], gap),
              normal, approach, approach - spin.cross(normal), vector_of(first.spin - second.spin));
  const Row force = row_of(load.force), turn = row_of(load.force.cross(normal)), couple = row_of(load.couple);
  first.force += force;
  second.force -= force;
  first.torque += first_arm * turn + couple;
  second.torque += second_arm * turn - couple;
}

void add_to_wall(MovingGrain& grain, const Plane& wall, const PeriodicBox& box,
                 const LubricationParameters& parameters) {
  const auto [height, n] = wall.seen_from(vector_of(grain.position), box);
  const double gap = height - grain.position[3];
  if (!(gap > 0.0 && gap < parameters.reach())) return;
  const Vec3 approach = vector_of(grain.velocity) - wall.velocity, spin = vector_of(grain.spin);
  const LubricationLoad load = load_of(lubrication_resistance(parameters, grain.position[3], 0.0, gap), n, approach,
                                       approach - height * spin.cross(n), spin);
  grain.force += row_of(load.force);
  grain.torque += row_of(height * load.force.cross(n) + load.couple);
}

}  // namespace

LubricationResistance lubrication_resistance(const LubricationParameters& parameters, double radius, double ratio,
                                             double gap) {
  const double smaller = ratio > 1.0 ? radius / ratio : radius;
  const double reduced = radius / (1.0 + ratio), h = std::max(gap, parameters.minimum_gap * smaller);
  LubricationResistance resistance;
  if (h < parameters.normal_cut_off)
    resistance.normal =
        6.0 * std::numbers::pi * parameters.viscosity * reduced * reduced * (1.0 / h - 1.0 / parameters.normal_cut_off);
  if (h < parameters.tangential_cut_off) {
    const double strength = std::numbers::pi * parameters.viscosity * std::log(parameters.tangential_cut_off / h);
    const double sum = 1.0 + ratio;
    resistance.sliding = strength * 1.6 * reduced * (2.0 + ratio + 2.0 * ratio * ratio) / (sum * sum);
    resistance.mixed = strength * 2.4 * reduced * reduced * (ratio - 1.0) / sum;
    resistance.rolling = strength * 4.8 * reduced * reduced * reduced;
  }
  return resistance;
}

void check(const LubricationParameters& parameters, double largest_radius, double radius_per_mass,
           const PeriodicBox& box, double time_step) {
  if (!(parameters.viscosity >= 0.0 && parameters.normal_cut_off >= 0.0 && parameters.tangential_cut_off >= 0.0))
    throw InputError(
        fmt::format("The viscosity of {:g} Pa s and the cut-offs of {:g} m and {:g} m of the lubrication "
                    "force must not be negative.",
                    parameters.viscosity, parameters.normal_cut_off, parameters.tangential_cut_off));
  if (!(parameters.minimum_gap > 0.0))
    throw InputError(
        fmt::format("The minimum gap of the lubrication force is {:g} radii; it must be positive, for example 1e-3.",
                    parameters.minimum_gap));
  const double shortest = 2.0 * (2.0 * largest_radius + parameters.reach());
  for (int axis = 0; axis < 3; ++axis)
    if (box.periodic[axis] && box.size[axis] < shortest)
      throw InputError(fmt::format(
          "The box is {:g} m long along the periodic axis {}; with the lubrication force on grains of {:g} m "
          "give at least {:g} m, two diameters and twice the cut-off.",
          box.size[axis], "xyz"[axis], 2.0 * largest_radius, shortest));
  const double rate = 6.0 * std::numbers::pi * parameters.viscosity * radius_per_mass / parameters.minimum_gap;
  if (rate * time_step <= largest_damping_a_step) return;
  throw InputError(fmt::format(
      "A step of the grains of {:g} s is too long for the lubrication force on the smallest that are free; "
      "give at most {:g} s or a minimum gap of at least {:g} radii.",
      time_step, largest_damping_a_step / rate, parameters.minimum_gap * rate * time_step / largest_damping_a_step));
}

void add_lubrication(MovingGrains& grains, const ContactList& list, const PeriodicBox& box,
                     std::span<const Plane> walls, const LubricationParameters& parameters) {
  for (const PairContact& c : list.pairs) {
    MovingGrain &first = grains[c.first], &second = grains[c.second];
    add_to_pair(first, second, box.difference(vector_of(first.position), vector_of(second.position)), parameters);
  }
  for (const WallContact& c : list.walls)
    if (parameters.walls[c.wall]) add_to_wall(grains[c.grain], walls[c.wall], box, parameters);
}

}  // namespace thalweg::dem
