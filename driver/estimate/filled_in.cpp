#include "driver/estimate/filled_in.hpp"

#include "driver/bed/bed_flow.hpp"
#include "driver/case/limit_text.hpp"
#include "driver/estimate/channel.hpp"
#include "driver/estimate/contact_estimate.hpp"
#include "driver/estimate/contact_stiffness.hpp"
#include "driver/estimate/flow_estimate.hpp"
#include "lbm/walls/law_of_the_wall.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace thalweg::driver {

namespace {

// Limits beyond which plan and case warnings advise a shorter step: docs/stability.md.
constexpr double accurate_excess = 0.029;

// The shear velocity (m/s) of the log law that has a mean (m/s) over a depth (m), by bisection: both rise together.
// roughness(u): m, where the velocity is zero.
template <typename Roughness>
double shear_velocity_of_mean(double mean, double depth, const Roughness& roughness) {
  const auto mean_of = [&](double shear_velocity) {
    const double ratio = depth / roughness(shear_velocity);
    return ratio > 1.0 ? shear_velocity / lbm::karman_constant * (std::log(ratio) - 1.0 + 1.0 / ratio) : 0.0;
  };
  constexpr int doublings = 60, halvings = 60;
  double low = 0.0, high = mean;
  for (int n = 0; n < doublings && mean_of(high) < mean; ++n) high *= 2.0;
  for (int n = 0; n < halvings; ++n) {
    const double middle = 0.5 * (low + high);
    (mean_of(middle) < mean ? low : high) = middle;
  }
  return high;
}

// Fills in the start that check advises: the log law that a turbulent flow over grains of this size comes to, and where
// the flow has another profile, because it is laminar or drags on the top, the log law of its discharge.
void fill_in_profile(Case& c) {
  if (!c.initial.fluid.log_profile) return;
  coupling::LogProfileKeys& profile = *c.initial.fluid.log_profile;
  const auto& open = c.filled_in.profile;
  if (open.bed_height) profile.bed_height.reset();
  if (open.shear_velocity) profile.shear_velocity.reset();
  if (open.roughness) profile.roughness.reset();
  const FlowEstimate flow = flow_estimate(c);
  const double given = profile.roughness.value_or(0.0);  // 0: it follows from the flow
  const auto roughness = [&](double shear_velocity) {
    if (given > 0.0) return given;
    return c.grains.empty() ? smooth_roughness(c.fluid.kinematic_viscosity, std::abs(shear_velocity))
                            : largest_size(c) / roughness_a_diameter;
  };
  if (open.bed_height) profile.bed_height = settled_height(c);
  if (open.shear_velocity) {
    profile.shear_velocity = flow.way * flow.friction_velocity;
    if (flow.bulk_velocity > 0.0 && (flow.laminar || c.domain.faces[top].drags()))
      profile.shear_velocity =
          flow.way * shear_velocity_of_mean(flow.bulk_velocity, c.domain.size.z() - *profile.bed_height, roughness);
  }
  if (open.roughness) profile.roughness = roughness(*profile.shear_velocity);
}

}  // namespace

double suitable_time_step(const Case& c) {
  Case endless = c;  // a run that goes on for longer keeps its step
  endless.run.until = std::numeric_limits<double>::infinity();
  const double spacing = c.domain.spacing, speed = flow_estimate(endless).speed;
  const double excess =
      lbm::traits_of(c.fluid.collision).is_trt_near_bodies ? accurate_excess_near_bodies : accurate_excess;
  double longest = excess * spacing * spacing / (3.0 * c.fluid.kinematic_viscosity);
  if (speed > 0.0) longest = std::min(longest, accurate_lattice_velocity * spacing / speed);
  if (c.gravity.mode == GravityMode::full)
    longest = std::min(
        longest,
        spacing * std::sqrt(largest_compression / (3.0 * std::abs(gravity_vector(c.gravity).z()) * c.domain.size[2])));
  const double pressure = largest_outlet_pressure(c);
  if (pressure > 0.0)
    longest = std::min(longest, spacing * std::sqrt(largest_compression * c.fluid.density / (3.0 * pressure)));
  return std::stod(at_most_text(longest, 2));
}

namespace {

// The step, and contacts that last as long as it asks for or, where they would overlap too far, a step that suits them.
void fill_in_step(Case& c) {
  if (!c.filled_in.time_step) return fill_in_contacts(c);
  c.fluid.time_step = suitable_time_step(c);
  fill_in_contacts(c);
  const std::optional<ReboundTimes> times = rebound_times(c);
  if (!has_default_duration(c) || !times || times->contact >= times->around) return;
  c.fluid.time_step = std::stod(at_most_text(*c.fluid.time_step * times->contact / times->around, 3));
  fill_in_contacts(c);
}

}  // namespace

void complete(Case& c) {
  if (has_fluid(c)) {
    c.filled_in.time_step = !c.fluid.time_step;
    if (const auto& profile = c.initial.fluid.log_profile)
      c.filled_in.profile = {!profile->bed_height, !profile->shear_velocity, !profile->roughness};
  }
  if (has_grains(c.system)) take_over_contacts(c);
  fill_in(c);
}

void fill_in(Case& c) {
  if (!has_fluid(c)) return fill_in_contacts(c);
  fill_in_profile(c);
  fill_in_step(c);
}

}  // namespace thalweg::driver
