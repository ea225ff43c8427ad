#include "driver/warnings/drive_warnings.hpp"

#include "driver/bed/bed_flow.hpp"
#include "driver/bed/grain_weight.hpp"
#include "driver/case/axes.hpp"
#include "driver/estimate/flow_drive.hpp"
#include "driver/estimate/flow_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thalweg::driver {

namespace {

using Sentences = std::vector<std::string>;

bool any_held(const Case& c) {
  return std::any_of(c.grains.begin(), c.grains.end(), [](const beds::Population& grains) { return grains.held(); });
}

// True if something at rest exerts drag along this axis of a periodic box: a face beside it, a grain or a solid.
bool is_held_along(const Case& c, int axis) {
  const std::array<bool, 3> periodic = periodic_axes(c.domain);
  if (any_held(c) || !c.solids.empty() || !c.walls.empty()) return true;
  for (std::size_t other = 0; other < 3; ++other) {
    if (other == static_cast<std::size_t>(axis) || periodic[other]) continue;
    if (!has_fluid(c) || c.domain.faces[2 * other].drags() || c.domain.faces[2 * other + 1].drags()) return true;
  }
  return false;
}

// m/s^2, that gravity gives to all that moves together, where nothing holds it.
Vec3 common_acceleration(const Case& c) {
  const Vec3 gravity = gravity_vector(c.gravity);
  if (!has_fluid(c)) return gravity;
  double grains = 0.0, excess = 0.0;  // kg
  for (const beds::Population& population : c.grains) {
    grains += population.density * population.volume();
    excess += (population.density - c.fluid.density) * population.volume();
  }
  const double mass = c.fluid.density * (c.domain.size.prod() - grain_volume(c)) + grains;
  return {gravity.x(), gravity.y(), gravity.z() * excess / mass};
}

// True if gravity.mode: balanced is possible (check_case()).
bool can_be_balanced(const Case& c) {
  const Vec3 gravity = gravity_vector(c.gravity);
  const std::array<bool, 3> periodic = periodic_axes(c.domain);
  for (int axis = 0; axis < 3; ++axis)
    if (gravity[axis] != 0.0 && !periodic[static_cast<std::size_t>(axis)]) return false;
  return has_fluid(c) && !c.grains.empty() && !balancing_acceleration(c).isZero(0.0);
}

std::string what_would_hold(const Case& c) {
  if (can_be_balanced(c)) return "gravity.mode: balanced";
  const bool has_floor = !periodic_axes(c.domain)[2];
  return has_floor ? "domain.boundaries.bottom: no_slip" : "domain.boundaries.bottom: no_slip and top: no_slip";
}

void warn_of_endless_acceleration(const Case& c, Sentences& found) {
  const Vec3 acceleration = common_acceleration(c);
  for (int axis = 0; axis < 3; ++axis) {
    const double gained = std::abs(acceleration[axis]);
    const bool steered = axis == 0 && has_fluid(c) && c.fluid.mean_velocity;
    if (!(gained > 0.0) || !periodic_axes(c.domain)[static_cast<std::size_t>(axis)] || steered) continue;
    if (is_held_along(c, axis)) continue;
    const char* what = !has_fluid(c) ? "the grains" : c.grains.empty() ? "the fluid" : "fluid and grains";
    found.push_back(
        fmt::format("The box is periodic along {} and nothing in it balances gravity, so {} gain {:.3g} m/s each "
                    "second without limit: consider {}.",
                    axis_name[axis], what, gained, what_would_hold(c)));
  }
}

void warn_of_closed_ends(const Case& c, Sentences& found) {
  const Vec3 gravity = gravity_vector(c.gravity);
  for (int axis = 0; axis < 2; ++axis)
    if (gravity[axis] != 0.0 && !drives_flow(c, axis))
      found.push_back(fmt::format(
          "Walls close the box along {0}, so gravity along it ({1:.3g} m/s^2) drives no flow and gives no Shields "
          "number: consider domain.boundaries.{0}: periodic{2}.",
          axis_name[axis], gravity[axis], c.gravity.slope ? ", or gravity.slope: 0 for water at rest" : ""));
}

// x points downstream.
void warn_of_uphill_flow(const Case& c, Sentences& found) {
  const Vec3 gravity = gravity_vector(c.gravity);
  if (c.grains.empty() || gravity.x() >= 0.0 || gravity.z() >= 0.0 || flow_estimate(c).drive != FlowCause::slope)
    return;
  found.push_back(fmt::format(
      "Gravity drives the flow towards -x, but {} take x as downstream: consider {}.",
      c.initial.fluid.log_profile ? "the log profile at the start, Shields number and bed stress"
                                  : "Shields number and bed stress",
      c.gravity.slope ? fmt::format("gravity.slope: {:g}", -*c.gravity.slope)
                      : fmt::format("gravity.vector: [{:g}, {:g}, {:g}]", -gravity.x(), gravity.y(), gravity.z())));
}

void warn_of_flow_across(const Case& c, Sentences& found) {
  const Vec3 driving = driving_gravity(c);
  if (c.grains.empty() || std::abs(driving.y()) <= std::abs(driving.x())) return;
  found.push_back(
      "Gravity drives the flow along y, but transport rate, hydraulic radius, bed stress and Shields number are those "
      "along x, which points downstream: turn the case.");
}

}  // namespace

std::vector<std::string> drive_warnings(const Case& c) {
  Sentences found;
  if (c.system == SystemKind::model_fluid || c.system == SystemKind::continuum) return found;
  if (!has_fluid(c) || c.gravity.mode != GravityMode::balanced) warn_of_endless_acceleration(c, found);
  if (!has_fluid(c)) return found;
  warn_of_closed_ends(c, found);
  warn_of_uphill_flow(c, found);
  warn_of_flow_across(c, found);
  return found;
}

}  // namespace thalweg::driver
