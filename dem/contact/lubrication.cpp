#include "dem/contact/lubrication.hpp"

#include "core/base/error.hpp"
#include "dem/laws/material.hpp"
#include "dem/motion/minimum_image.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace thalweg::dem {

namespace {

constexpr double largest_damping_a_step = 0.5;

// Force on the first body, and the couple on it beyond the moment of that force.
struct LubricationLoad {
  Vec3 force, couple;
};

// normal: unit, from the second to the first; sliding: of the first surface against the second; both spins against each
// other.
LubricationLoad averaged_load(const LubricationResistance& resistance, const Vec3& normal, const Vec3& approach,
                              const Vec3& surface_velocity, const Vec3& spin) {
  const Vec3 sliding = surface_velocity - surface_velocity.dot(normal) * normal;
  const Vec3 rolling = spin - spin.dot(normal) * normal;
  return {-resistance.normal * approach.dot(normal) * normal - resistance.sliding * sliding +
              resistance.mixed * rolling.cross(normal),
          resistance.mixed * normal.cross(sliding) - resistance.rolling * rolling};
}

// Properties of a grain that the force depends on.
struct MovingSphere {
  double radius;
  Vec3 velocity, spin;
};
MovingSphere moving_sphere_of(const PackedGrain& grain) {
  return {grain.position[3], vector_of(grain.velocity), vector_of(grain.spin)};
}
MovingSphere moving_sphere_of(const GrainStore& store, std::size_t slot) {
  return {store.radius[slot], store.velocity[slot], store.angular_velocity[slot]};
}

// Between two surfaces that are near: where, and what acts on the first.
struct NearSurfaces {
  Vec3 normal;                   // from the second to the first
  double first_arm, second_arm;  // m, from each centre to the middle of the gap; of a wall the first to its surface
  LubricationLoad load;
};

std::optional<NearSurfaces> between(const MovingSphere& first, const MovingSphere& second, const Vec3& separation,
                                    const LubricationParameters& parameters) {
  const double reach = first.radius + second.radius + parameters.reach(), square = separation.squaredNorm();
  if (square >= reach * reach) return std::nullopt;
  const double distance = std::sqrt(square), gap = distance - first.radius - second.radius;
  if (!(gap > 0.0)) return std::nullopt;
  const Vec3 normal = separation / distance;
  const double first_arm = first.radius + 0.5 * gap, second_arm = second.radius + 0.5 * gap;
  const Vec3 approach = first.velocity - second.velocity, spin = first_arm * first.spin + second_arm * second.spin;
  return NearSurfaces{normal, first_arm, second_arm,
                      averaged_load(lubrication_resistance(parameters, first.radius, first.radius / second.radius, gap),
                                    normal, approach, approach - spin.cross(normal), first.spin - second.spin)};
}

// ratio: the radius of the sphere over that of what it is near; 0 of a plane.
std::optional<NearSurfaces> between(const MovingSphere& sphere, const WallView& view, const Vec3& wall_velocity,
                                    double ratio, const LubricationParameters& parameters) {
  const auto [height, n] = view;
  const double gap = height - sphere.radius;
  if (!(gap > 0.0 && gap < parameters.reach())) return std::nullopt;
  const Vec3 approach = sphere.velocity - wall_velocity;
  return NearSurfaces{n, height, 0.0,
                      averaged_load(lubrication_resistance(parameters, sphere.radius, ratio, gap), n, approach,
                                    approach - height * sphere.spin.cross(n), sphere.spin)};
}

void add_to_pair(PackedGrain& first, PackedGrain& second, const Vec3& separation,
                 const LubricationParameters& parameters) {
  const auto near = between(moving_sphere_of(first), moving_sphere_of(second), separation, parameters);
  if (!near) return;
  const LubricationLoad& load = near->load;
  const Double4 force = double4(load.force), turn = double4(load.force.cross(near->normal)),
                couple = double4(load.couple);
  first.force += force;
  second.force -= force;
  first.torque += near->first_arm * turn + couple;
  second.torque += near->second_arm * turn - couple;
}

// Finds the pairs between which the force may act before the list is searched again. reach: m.
void look_for_near_surfaces(const PackedGrainState& grains, NeighbourList& list, double reach,
                            const MinimumImage& image) {
  list.near_surfaces.begin();
  const double range = reach + list.near_surfaces.margin();
  for (std::size_t p = 0; p < list.pairs.size(); ++p) {
    const PairContact& c = list.pairs[p];
    const Double4 d = image(grains[c.first].position - grains[c.second].position), square = d * d;
    const double limit = c.reach + range;
    if (square[0] + square[1] + square[2] < limit * limit)
      list.near_surfaces.add({c.first, c.second, static_cast<std::uint32_t>(p)});
  }
}

void add_to_grain(PackedGrain& grain, const NearSurfaces& near) {
  grain.force += double4(near.load.force);
  grain.torque += double4(near.first_arm * near.load.force.cross(near.normal) + near.load.couple);
}

// Calls visit(slot, partner, surfaces) for every wall and every place of a solid that is near a grain. sphere_of(slot)
// and position_of(slot): as the grain is now.
template <typename SphereOf, typename PositionOf, typename Visit>
void for_each_near_wall(const NeighbourList& list, const Surroundings& around, const LubricationParameters& parameters,
                        SphereOf sphere_of, PositionOf position_of, Visit visit) {
  for (const WallContact& c : list.walls) {
    if (!parameters.walls[c.wall]) continue;
    const Plane& wall = around.walls[c.wall];
    const WallView view = wall.seen_from(position_of(c.grain), around.box);
    if (const auto near = between(sphere_of(c.grain), view, wall.velocity, 0.0, parameters))
      visit(c.grain, c.wall, *near);
  }
  SolidTouches touches(around.box, around.placed, around.solids);
  SolidTouches::for_each_grain(list.solids, [&](std::size_t first, std::size_t last) {
    const std::uint32_t slot = list.solids[first].grain;
    const MovingSphere sphere = sphere_of(slot);
    const auto without_history = [](std::size_t, std::size_t) -> Vec3 { return Vec3::Zero(); };
    for (const SolidTouch& touch :
         touches.of(list.solids, first, last, position_of(slot), sphere.radius, parameters.reach(), without_history)) {
      const double ratio = sphere.radius / touch.effective_radius - 1.0;
      if (const auto near = between(sphere, touch.view, touch.velocity, ratio, parameters))
        visit(slot, around.walls.size() + list.solids[touch.near].solid, *near);
    }
  });
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

double longest_lubrication_step(const LubricationParameters& parameters, double radius_per_mass) {
  const double rate = 6.0 * std::numbers::pi * parameters.viscosity * radius_per_mass / parameters.minimum_gap;
  return rate > 0.0 ? largest_damping_a_step / rate : std::numeric_limits<double>::infinity();
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
  const double longest = longest_lubrication_step(parameters, radius_per_mass);
  if (time_step <= longest * (1.0 + rounding_of_a_step)) return;
  throw InputError(
      fmt::format("A step of the grains of {:g} s is too long for the lubrication force on the smallest that are free; "
                  "give at most {:g} s or a minimum gap of at least {:g} radii.",
                  time_step, longest, parameters.minimum_gap * time_step / longest));
}

void add_lubrication(PackedGrainState& grains, NeighbourList& list, const Surroundings& around,
                     const LubricationParameters& parameters) {
  if (list.near_surfaces.stale()) look_for_near_surfaces(grains, list, parameters.reach(), MinimumImage(around.box));
  for (const NearPair& c : list.near_surfaces.pairs()) {
    PackedGrain &first = grains[c.first], &second = grains[c.second];
    add_to_pair(first, second, around.box.difference(vector_of(first.position), vector_of(second.position)),
                parameters);
  }
  for_each_near_wall(
      list, around, parameters, [&](std::uint32_t slot) { return moving_sphere_of(grains[slot]); },
      [&](std::uint32_t slot) { return vector_of(grains[slot].position); },
      [&](std::uint32_t slot, std::size_t, const NearSurfaces& near) { add_to_grain(grains[slot], near); });
}

void for_each_lubrication_end(const GrainStore& store, const NeighbourList& list, const Surroundings& around,
                              const LubricationParameters& parameters, const LubricationVisitor& visit) {
  for (const PairContact& c : list.pairs) {
    const auto near = between(moving_sphere_of(store, c.first), moving_sphere_of(store, c.second),
                              around.box.difference(store.position[c.first], store.position[c.second]), parameters);
    if (!near) continue;
    if (!store.is_ghost(c.first)) visit(c.first, -near->first_arm * near->normal, near->load.force);
    if (!store.is_ghost(c.second)) visit(c.second, near->second_arm * near->normal, -near->load.force);
  }
  for_each_wall_lubrication(store, list, around, parameters,
                            [&visit](std::size_t slot, const ContactEnd& end) { visit(slot, end.arm, end.force); });
}

void for_each_wall_lubrication(const GrainStore& store, const NeighbourList& list, const Surroundings& around,
                               const LubricationParameters& parameters, const ContactSource::ContactEndVisitor& visit) {
  for_each_near_wall(
      list, around, parameters, [&](std::uint32_t slot) { return moving_sphere_of(store, slot); },
      [&](std::uint32_t slot) { return store.position[slot]; },
      [&](std::uint32_t slot, std::size_t partner, const NearSurfaces& near) {
        if (store.is_ghost(slot)) return;
        const Vec3 arm = -near.first_arm * near.normal;
        visit(slot, {arm, near.load.force, -1 - static_cast<GlobalId>(partner), arm});
      });
}

}  // namespace thalweg::dem
