#include "dem/contact/lubrication.hpp"

#include "core/base/error.hpp"
#include "dem/contact/contact_motion.hpp"
#include "dem/contact/lubrication_shares.hpp"
#include "dem/contact/wall_touches.hpp"
#include "dem/laws/material.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

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

// Between two surfaces that are near: where, and what acts on the first.
struct NearSurfaces {
  Vec3 normal;                   // from the second to the first
  double first_arm, second_arm;  // m, from each centre to the middle of the gap; of a wall the first to its surface
  LubricationLoad load;
  double reduced_radius, gap;  // m, the latter at least the minimum gap
};

std::optional<NearSurfaces> between(const ContactBody& first, const ContactBody& second, const Vec3& separation,
                                    const LubricationParameters& parameters) {
  const double reach = first.radius + second.radius + parameters.reach(), square = separation.squaredNorm();
  if (square >= reach * reach) return std::nullopt;
  const double distance = std::sqrt(square), gap = distance - first.radius - second.radius;
  if (!(gap > 0.0)) return std::nullopt;
  const Vec3 normal = separation / distance;
  const double first_arm = first.radius + 0.5 * gap, second_arm = second.radius + 0.5 * gap;
  const Vec3 approach = first.velocity - second.velocity, spin = first_arm * first.spin + second_arm * second.spin;
  return NearSurfaces{normal,
                      first_arm,
                      second_arm,
                      averaged_load(lubrication_resistance(parameters, first.radius, first.radius / second.radius, gap),
                                    normal, approach, approach - spin.cross(normal), first.spin - second.spin),
                      first.radius * second.radius / (first.radius + second.radius),
                      std::max(gap, parameters.minimum_gap * std::min(first.radius, second.radius))};
}

std::optional<NearSurfaces> between(const ContactBody& sphere, const WallTouch& wall,
                                    const LubricationParameters& parameters) {
  const auto [height, n] = wall.view;
  const double gap = height - sphere.radius;
  if (!(gap > 0.0 && gap < parameters.reach())) return std::nullopt;
  const double ratio = sphere.radius / wall.effective_radius - 1.0;  // of the radii; 0 at a plane
  const Vec3 approach = sphere.velocity - wall.velocity;
  return NearSurfaces{n,
                      height,
                      0.0,
                      averaged_load(lubrication_resistance(parameters, sphere.radius, ratio, gap), n, approach,
                                    approach - height * sphere.spin.cross(n), sphere.spin - wall.spin),
                      wall.effective_radius,
                      std::max(gap, parameters.minimum_gap * sphere.radius)};
}

void add_to_pair(PackedGrain& first, PackedGrain& second, const NearSurfaces& near) {
  const Double4 force = double4(near.load.force), turn = double4(near.load.force.cross(near.normal)),
                couple = double4(near.load.couple);
  first.force += force;
  second.force -= force;
  first.torque += near.first_arm * turn + couple;
  second.torque += near.second_arm * turn - couple;
}

// Number of the body that a grain is or belongs to. clump: ids, of every slot; empty: there are no clumps.
std::int64_t body_number(std::span<const GlobalId> clump, std::size_t slot) {
  const bool is_member = !clump.empty() && clump[slot] >= 0;
  return is_member ? clump[slot] : -1 - static_cast<std::int64_t>(slot);
}

// Calls visit(near) for all of these, with the share of each in its load. all: with `surfaces`.
template <typename Near, typename Visit>
void visit_shares(std::vector<Near>& all, std::span<const NearPlace> places, const PeriodicBox& box, Visit visit) {
  const std::vector<double> shares = lubrication_shares(places, box);
  for (std::size_t n = 0; n < all.size(); ++n) {
    all[n].surfaces.load.force *= shares[n];
    all[n].surfaces.load.couple *= shares[n];
    visit(all[n]);
  }
}

// Calls visit(first, second, surfaces) where the two grains of a pair are near each other. Pairs: with slots `first`
// and `second`. clump: as above.
template <typename Grains, typename Pairs, typename Visit>
void for_each_near_pair(const Grains& grains, const Pairs& pairs, std::span<const GlobalId> clump,
                        const PeriodicBox& box, const LubricationParameters& parameters, Visit visit) {
  const auto visit_near = [&](const auto& visitor) {
    for (const auto& c : pairs) {
      const Vec3 separation = box.difference(position_of(grains, c.first), position_of(grains, c.second));
      if (const auto near = between(body_of(grains, c.first), body_of(grains, c.second), separation, parameters))
        visitor(c.first, c.second, *near);
    }
  };
  if (clump.empty()) return visit_near(visit);
  struct Near {
    std::size_t first, second;
    NearSurfaces surfaces;
  };
  std::vector<Near> all;
  std::vector<NearPlace> places;
  visit_near([&](std::size_t first, std::size_t second, const NearSurfaces& near) {
    all.push_back({first, second, near});
    places.push_back({body_number(clump, first), body_number(clump, second), first, second, position_of(grains, first),
                      position_of(grains, second), radius_of(grains, first), radius_of(grains, second), near.normal,
                      near.reduced_radius, near.gap});
  });
  visit_shares(all, places, box, [&visit](const Near& near) { visit(near.first, near.second, near.surfaces); });
}

void add_to_grain(PackedGrain& grain, const NearSurfaces& near) {
  grain.force += double4(near.load.force);
  grain.torque += double4(near.first_arm * near.load.force.cross(near.normal) + near.load.couple);
}

// Calls visit(touch, surfaces) for every wall and every place of a solid that is near a grain. clump: as above.
template <typename Grains, typename Visit>
void for_each_near_wall(const Grains& grains, const NeighbourList& list, const Surroundings& around,
                        std::span<const GlobalId> clump, const LubricationParameters& parameters, Visit visit) {
  const auto visit_near = [&](const auto& visitor) {
    const auto visit_touch = [&](const WallTouch& touch) {
      if (touch.wall < around.walls.size() && !parameters.walls[touch.wall]) return;
      if (const auto near = between(body_of(grains, touch.slot), touch, parameters)) visitor(touch, *near);
    };
    for_each_wall_touch(grains, list, around, visit_touch);
    for_each_solid_touch(grains, list, around, parameters.reach(), visit_touch);
  };
  if (clump.empty()) return visit_near(visit);
  struct Near {
    WallTouch touch;
    NearSurfaces surfaces;
  };
  std::vector<Near> all;
  std::vector<NearPlace> places;
  visit_near([&](const WallTouch& touch, const NearSurfaces& near) {
    all.push_back({touch, near});
    places.push_back({body_number(clump, touch.slot), static_cast<std::int64_t>(touch.wall), touch.slot, 0,
                      position_of(grains, touch.slot), Vec3::Zero(), radius_of(grains, touch.slot), 0.0, near.normal,
                      near.reduced_radius, near.gap});
  });
  visit_shares(all, places, around.box, [&visit](const Near& near) { visit(near.touch, near.surfaces); });
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
                     std::span<const GlobalId> clump, const LubricationParameters& parameters) {
  if (list.near_surfaces.stale())
    look_for_near_pairs(grains, list.pairs, parameters.reach(), around.box, list.near_surfaces, [](std::size_t) {});
  for_each_near_pair(grains, list.near_surfaces.pairs(), clump, around.box, parameters,
                     [&](std::size_t first, std::size_t second, const NearSurfaces& near) {
                       add_to_pair(grains[first], grains[second], near);
                     });
  for_each_near_wall(grains, list, around, clump, parameters,
                     [&](const WallTouch& touch, const NearSurfaces& near) { add_to_grain(grains[touch.slot], near); });
}

void for_each_lubrication_end(const ActingGrains& grains, const NeighbourList& list, const Surroundings& around,
                              const LubricationParameters& parameters, const LubricationVisitor& visit) {
  const GrainStore& store = grains.store;
  for_each_near_pair(grains, list.pairs, store.clump, around.box, parameters,
                     [&](std::size_t first, std::size_t second, const NearSurfaces& near) {
                       if (!store.is_ghost(first)) visit(first, -near.first_arm * near.normal, near.load.force);
                       if (!store.is_ghost(second)) visit(second, near.second_arm * near.normal, -near.load.force);
                     });
  for_each_wall_lubrication(grains, list, around, parameters,
                            [&visit](std::size_t slot, const ContactEnd& end) { visit(slot, end.arm, end.force); });
}

void for_each_wall_lubrication(const ActingGrains& grains, const NeighbourList& list, const Surroundings& around,
                               const LubricationParameters& parameters, const ContactSource::ContactEndVisitor& visit) {
  for_each_near_wall(grains, list, around, grains.store.clump, parameters,
                     [&](const WallTouch& touch, const NearSurfaces& near) {
                       if (grains.store.is_ghost(touch.slot)) return;
                       const Vec3 arm = -near.first_arm * near.normal;
                       visit(touch.slot, {arm, near.load.force, touch.partner(), arm});
                     });
}

}  // namespace thalweg::dem
