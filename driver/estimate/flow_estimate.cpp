#include "driver/estimate/flow_estimate.hpp"

#include "driver/bed/bed_flow.hpp"
#include "driver/bed/obstacles.hpp"
#include "driver/bed/supplied_grains.hpp"
#include "driver/case/solid_setup.hpp"
#include "driver/estimate/channel.hpp"
#include "driver/estimate/flow_drive.hpp"
#include "driver/estimate/pore_speed.hpp"
#include "driver/estimate/settling.hpp"
#include "lbm/walls/law_of_the_wall.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace thalweg::driver {

namespace {

using lbm::karman_constant;

constexpr double infinite = std::numeric_limits<double>::infinity();
// Transition: of U R/nu, and of Couette flow V H/nu (Tillmark and Alfredsson 1992: 360 with half of both).
constexpr double channel_transition = 500.0, couette_transition = 1440.0;
constexpr double turnovers_to_adapt = 10.0, response_times_to_settle = 9.5;

// The friction velocity u_tau = kappa velocity/logarithms(u_tau), by iteration from a twentieth of the velocity.
template <typename Law>
double friction_velocity_of(double velocity, const Law& logarithms) {
  double friction_velocity = velocity / 20.0;
  for (int n = 0; n < 50; ++n) friction_velocity = karman_constant * velocity / logarithms(friction_velocity);
  return friction_velocity;
}

// Raises the estimate to `speed` (m/s): of a face, the start, or grains, and so of the fluid next to them.
void consider(FlowEstimate& flow, double speed, FlowCause cause) {
  if (!(speed > flow.speed)) return;
  flow.speed = speed;
  flow.cause = cause;
}

bool is_complete(const coupling::LogProfileKeys& profile) {
  return profile.bed_height && profile.shear_velocity && profile.roughness;
}

void consider_start(const Case& c, FlowEstimate& flow) {
  const coupling::InitialFluidKeys& start = c.initial.fluid;
  if (start.uniform) consider(flow, start.uniform->norm(), FlowCause::initial_fluid);
  if (start.linear_profile) consider(flow, start.linear_profile->velocity.norm(), FlowCause::initial_fluid);
  if (!start.log_profile || !is_complete(*start.log_profile)) return;
  const double height = (c.domain.size.z() - *start.log_profile->bed_height) / *start.log_profile->roughness;
  if (height > 1.0)
    consider(flow, std::abs(*start.log_profile->shear_velocity) / karman_constant * std::log(height),
             FlowCause::initial_fluid);
}

// A slope adds no more than g_x times the time of the run to the speed of the start.
void limit_to_what_the_slope_gives(const Case& c, double along, FlowEstimate& flow) {
  if (c.initial.takes(InitialField::fluid)) return;
  FlowEstimate start;
  consider_start(c, start);
  const double reached = start.speed + along * c.run.until;
  flow.still_gaining = reached < flow.speed;
  flow.speed = std::min(flow.speed, reached);
}

// Smooth walls on either side: the law of the wall holds over half the width.
double velocity_between_side_walls(double friction_velocity, const Channel& channel) {
  const double distance =
      smooth_wall_number * friction_velocity * std::min(channel.reach, channel.half_width) / channel.viscosity;
  return distance > std::numbers::e ? friction_velocity / karman_constant * std::log(distance) : infinite;
}

bool holds_back(const coupling::FaceKeys& face) {
  return face.type == lbm::FaceType::no_slip || face.obeys_the_law_of_the_wall();
}

struct TurbulentFlow {
  double largest, mean;  // m/s, u_max and U
};

// The flow that this acceleration (m/s^2) drives along the bed. The mean of a log law is its own friction velocity over
// kappa below its largest value.
TurbulentFlow turbulent_flow(const Case& c, const Channel& channel, double along) {
  const double of_walls = std::sqrt(along * channel.radius), of_bed = std::sqrt(along * channel.distance());
  const double between = holds_back(c.domain.faces[y_low]) && holds_back(c.domain.faces[y_high])
                             ? velocity_between_side_walls(of_walls, channel)
                             : infinite;
  const double over_bed = of_bed / karman_constant * channel.log_of(channel.distance(), of_bed);
  const double largest = std::min(over_bed, between), friction_velocity = between < over_bed ? of_walls : of_bed;
  return {largest, std::max(0.5 * largest, largest - friction_velocity / karman_constant)};
}

double acceleration_along(const Case& c) {
  const Vec3 driving = driving_acceleration(c);
  return std::hypot(driving.x(), driving.y());
}

struct SlopeFlow {
  double speed, bulk_velocity, friction_velocity;  // m/s, without end
  bool laminar;
  double spin_up;  // s
};

SlopeFlow flow_in_long_channel(const Case& c, const Channel& channel, double along) {
  const LaminarChannel slow = channel.laminar(along);
  const double friction_velocity = std::sqrt(along * channel.radius);
  if (slow.mean * channel.radius / channel.viscosity < channel_transition)
    return {slow.largest, slow.mean, friction_velocity, true, slow.spin_up};
  const TurbulentFlow fast = turbulent_flow(c, channel, along);
  return {fast.largest, fast.mean, friction_velocity, false, 2.0 * fast.mean / along};
}

// Between two outlets friction takes only what the head of the entering fluid leaves.
SlopeFlow developed_flow(const Case& c, const Channel& channel, double along) {
  SlopeFlow flow = flow_in_long_channel(c, channel, along);
  const double limit = speed_through_outlets(c), share = limit / flow.speed;
  if (share >= 1.0) return flow;
  flow.speed = limit;
  flow.bulk_velocity *= share;
  flow.friction_velocity *= flow.laminar ? std::sqrt(share) : share;
  flow.spin_up = 2.0 * flow.bulk_velocity / along;
  return flow;
}

FlowCause cause_along(const Case& c) {
  return driving_pressure(c).norm() > driving_gravity(c).norm() ? FlowCause::outlets : FlowCause::slope;
}

FlowEstimate flow_of_slope(const Case& c, const Channel& channel) {
  FlowEstimate flow;
  const double along = acceleration_along(c);
  if (along == 0.0) return flow;
  const SlopeFlow developed = developed_flow(c, channel, along);
  flow.cause = flow.drive = cause_along(c);
  flow.speed = developed.speed;
  flow.bulk_velocity = developed.bulk_velocity;
  flow.friction_velocity = developed.friction_velocity;
  flow.laminar = developed.laminar;
  flow.spin_up = developed.spin_up;
  limit_to_what_the_slope_gives(c, along, flow);
  return flow;
}

// Of a discharge with this mean velocity (m/s) over the depth, without the time that it takes.
FlowEstimate flow_of_discharge(double mean, FlowCause drive, const Channel& channel) {
  FlowEstimate flow;
  flow.cause = flow.drive = drive;
  flow.bulk_velocity = mean;
  flow.laminar = mean * channel.radius / channel.viscosity < channel_transition;
  if (flow.laminar) {
    const LaminarChannel of_unit = channel.laminar(1.0);
    flow.friction_velocity = std::sqrt(mean / of_unit.mean * channel.radius);
    flow.speed = mean * of_unit.largest / of_unit.mean;
    return flow;
  }
  flow.friction_velocity = friction_velocity_of(mean, [&](double friction_velocity) {
    return std::max(1.0, channel.log_of(channel.distance(), friction_velocity) - 1.0);
  });
  flow.speed = mean + flow.friction_velocity / karman_constant;
  return flow;
}

// s, in which a profile follows its discharge.
double time_to_adapt(const FlowEstimate& flow, const Channel& channel) {
  return flow.laminar ? channel.laminar(1.0).spin_up : turnovers_to_adapt * channel.depth / flow.friction_velocity;
}

FlowEstimate flow_of_mean_velocity(const Case& c, const Channel& channel) {
  if (!c.fluid.mean_velocity || c.fluid.mean_velocity->velocity == 0.0) return {};
  const Vec3 size = c.domain.size;
  const SolidsBelow solids = solids_below(c);
  const double water = size.x() * size.y() * size.z() - solid_volume(c) - (solids ? solids(1).back() : 0.0);
  const double mean = std::abs(c.fluid.mean_velocity->velocity) * water / (size.x() * size.y() * channel.depth);
  FlowEstimate flow = flow_of_discharge(mean, FlowCause::mean_velocity, channel);
  flow.spin_up = response_times_to_settle * c.fluid.mean_velocity->response_time + time_to_adapt(flow, channel);
  return flow;
}

// Of an inlet upstream. A flow that nothing holds back keeps the profile of its inlet and has no friction velocity.
FlowEstimate flow_of_inlet(const Case& c, const Channel& channel) {
  const coupling::FaceKeys* inlet = inlet_of(c);
  if (!inlet || !channel.is_held()) return {};
  const double mean = std::abs(inlet->velocity.x()) * c.domain.size.z() / channel.depth;
  FlowEstimate flow = flow_of_discharge(mean, FlowCause::inlet, channel);
  flow.spin_up = inlet->recycling_plane ? time_to_adapt(flow, channel) : c.domain.size.x() / mean;
  return flow;
}

FlowEstimate flow_of_moving_top(const Case& c, const Channel& channel) {
  FlowEstimate flow;
  const coupling::FaceKeys& lid = c.domain.faces[top];
  const double velocity = std::hypot(lid.velocity.x(), lid.velocity.y()), depth = channel.depth;
  if (lid.type != lbm::FaceType::moving || velocity == 0.0) return flow;
  flow.cause = flow.drive = FlowCause::moving_face;
  flow.speed = velocity;
  flow.bulk_velocity = 0.5 * velocity;
  flow.laminar = velocity * depth / channel.viscosity < couette_transition;
  if (flow.laminar) {
    flow.friction_velocity = std::sqrt(channel.viscosity * velocity / depth);
    flow.spin_up = 0.3 * depth * depth / channel.viscosity;
    return flow;
  }
  flow.friction_velocity = friction_velocity_of(velocity, [&](double friction_velocity) {
    return channel.log_of(0.5 * depth, friction_velocity) +
           std::max(1.0, std::log(0.5 * smooth_wall_number * friction_velocity * depth / channel.viscosity));
  });
  flow.spin_up = velocity * depth / (flow.friction_velocity * flow.friction_velocity);
  return flow;
}

// Cosine of the angle from x to the flow of a drive.
double way_of(const Case& c, FlowCause drive) {
  const auto sign = [](double velocity) { return velocity < 0.0 ? -1.0 : 1.0; };
  const auto cosine = [](const Vec3& along) { return along.x() / std::hypot(along.x(), along.y()); };
  if (drive == FlowCause::slope || drive == FlowCause::outlets) return cosine(driving_acceleration(c));
  if (drive == FlowCause::mean_velocity) return sign(c.fluid.mean_velocity->velocity);
  if (drive == FlowCause::moving_face) return cosine(c.domain.faces[top].velocity);
  return drive == FlowCause::inlet ? sign(inlet_of(c)->velocity.x()) : 1.0;
}

void consider_faces(const Case& c, const Channel& channel, FlowEstimate& flow) {
  for (std::size_t face = 0; face < c.domain.faces.size(); ++face) {
    const coupling::FaceKeys& keys = c.domain.faces[face];
    if (keys.type == lbm::FaceType::moving) consider(flow, keys.velocity.norm(), FlowCause::moving_face);
    // All that comes in beside a bed has to flow above it.
    const double squeezed = face < bottom && channel.depth > 0.0 ? c.domain.size.z() / channel.depth : 1.0;
    // A profile that has developed is at most that of laminar flow, 3/2 of the mean under a free surface.
    const double peak = keys.recycling_plane ? 1.5 : 1.0;
    if (keys.type == lbm::FaceType::velocity_inlet)
      consider(flow, keys.velocity.norm() * squeezed * peak, FlowCause::inlet);
  }
}

// m/s, the largest that a grain of a rigid population can have anywhere in its region or the box.
double rigid_speed(const Case& c, const beds::Population& grains) {
  const dem::PrescribedMotion motion = prescribed_motion(*grains.motion);
  std::vector<Vec3> places = grains.placement.positions;
  const beds::RegionKeys room = region_of(c, grains);
  for (int corner = 0; corner < 8 && grains.placement.positions.empty(); ++corner)
    places.emplace_back((corner & 1 ? room.upper : room.lower)[0], (corner & 2 ? room.upper : room.lower)[1],
                        (corner & 4 ? room.upper : room.lower)[2]);
  double distance = 0.0;
  for (const Vec3& place : places) distance = std::max(distance, motion.axis.cross(place - motion.centre).norm());
  return motion.largest_speed(distance + 0.5 * grains.largest_diameter());
}

bool starts_from_a_bed(const Case& c, const beds::Population& grains) {
  return c.initial.takes(InitialField::grains) || grains.from_file();
}

}  // namespace

const char* words_of(FlowCause cause) {
  switch (cause) {
    case FlowCause::none:
      return "nothing moves it";
    case FlowCause::slope:
      return "slope and depth";
    case FlowCause::outlets:
      return "the pressures of the outlets";
    case FlowCause::mean_velocity:
      return "the mean velocity over the bed";
    case FlowCause::moving_face:
      return "a moving face";
    case FlowCause::inlet:
      return "an inlet";
    case FlowCause::initial_fluid:
      return "the start";
    case FlowCause::moving_grains:
      return "the given speed of grains";
    case FlowCause::moving_solids:
      return "the given motion of solids";
    case FlowCause::settling:
      return "around grains that fall";
  }
  return "";
}

double given_speed(const Case& c, const beds::Population& grains) {
  if (grains.motion) return rigid_speed(c, grains);
  if (grains.fixed) return 0.0;
  const Vec3 velocity = grains.prescribed_velocity.value_or(grains.velocity),
             spin = grains.prescribed_angular_velocity.value_or(grains.angular_velocity);
  return velocity.norm() + 0.5 * grains.largest_extent() * spin.norm();
}

double estimated_velocity(const Case& c) {
  if (!has_fluid(c)) return 0.0;
  const Channel channel = channel_of(c);
  const double along = acceleration_along(c);
  return along == 0.0 || channel.depth <= 0.0 ? 0.0 : developed_flow(c, channel, along).speed;
}

FlowEstimate flow_estimate(const Case& c) {
  FlowEstimate flow;
  if (!has_fluid(c)) return flow;
  const Channel channel = channel_of(c);
  if (channel.depth > 0.0 && c.domain.faces[bottom].type != lbm::FaceType::periodic) {
    const FlowEstimate drives[] = {flow_of_slope(c, channel), flow_of_mean_velocity(c, channel),
                                   flow_of_moving_top(c, channel), flow_of_inlet(c, channel)};
    flow = *std::max_element(std::begin(drives), std::end(drives), [](const FlowEstimate& a, const FlowEstimate& b) {
      return a.friction_velocity < b.friction_velocity;
    });
    flow.depth = channel.depth;
    flow.way = way_of(c, flow.drive);
    for (const FlowEstimate& drive : drives) consider(flow, drive.speed, drive.cause);
  } else if (c.fluid.mean_velocity) {
    consider(flow, std::abs(c.fluid.mean_velocity->velocity), FlowCause::mean_velocity);
  } else {
    consider(flow, estimated_velocity(c), cause_along(c));
  }
  consider_faces(c, channel, flow);
  consider(flow, pore_speed_of_mean_velocity(c), FlowCause::mean_velocity);
  consider(flow, pore_speed_of_inlets(c), FlowCause::inlet);
  consider_start(c, flow);
  for (const beds::Population& grains : c.grains) {
    consider(flow, given_speed(c, grains), FlowCause::moving_grains);
    if (!grains.held() && !starts_from_a_bed(c, grains)) consider(flow, falling_speed(c, grains), FlowCause::settling);
  }
  consider(flow, fastest_supply(c), FlowCause::moving_grains);
  for (const SolidCase& solid : c.solids) consider(flow, largest_speed(solid), FlowCause::moving_solids);
  return flow;
}

}  // namespace thalweg::driver
