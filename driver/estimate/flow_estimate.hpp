// Speed that the fluid of a case reaches, its cause, and the time it takes: estimates from the case alone, for
// `thalweg check` and its warnings.
//
// A flow along the bed has the depth H, each of its surfaces h, and the hydraulic radius R (channel.hpp). It is laminar
// below U R/nu = 500, that is 2000 with the hydraulic diameter 4 R.
//
//   slope           laminar: u_max and U of the channel of h and the width (laminar_channel.hpp)
//                   turbulent: u_max = (u_b/kappa) ln(h/z_0) with u_b^2 = g_x h, U = u_max - u_b/kappa; between two
//                   side walls at most that of their law, with u_tau for u_b;
//                   at most the start + g_x times the time of the run; u_tau^2 = g_x R
//   outlets         of different pressures, the same with (p_low - p_high)/(rho L) added to g_x; at most sqrt(2 g_x L),
//                   as the water that enters comes from rest
//   mean velocity   the water above the bed carries it all: U = mean velocity times water/(A H);
//                   laminar: u_tau and u_max of the same channel
//                   turbulent: U = (u_tau/kappa) [ln(h/z_0) - 1], u_max = U + u_tau/kappa
//   inlet upstream  the same with U = V times the height of the box over H
//   moving top      u_max = V, U = V/2; laminar (V H/nu < 1440): u_tau^2 = nu V/H
//                   turbulent, log laws that meet half-way: V = (u_tau/kappa) [ln(H/(2 z_0)) + ln(9 u_tau H/(2 nu))]
//
// Gravity drives no flow across walls, and none along an axis where an inlet or a mean velocity sets how much flows
// (flow_drive.hpp). The speed is at least that in the pores of a bed which the flow passes (pore_speed.hpp), of single
// grains that fall (settling.hpp), of moving faces, of the start, and of grains and solids whose motion is given.
//
// Time from rest to 95 %: twice the water's momentum over the force, 2 U/g_x under a slope (from dU/dt = g_x (1 -
// U^2/U_end^2)) and 2 U H/u_tau^2 under a moving top; laminar, by the slowest mode, that of the channel, and
// 0.3 H^2/nu under a moving top; a held mean velocity 9.5 response times, then ten H/u_tau until the profile has
// followed; behind an inlet that recycles the flow ten H/u_tau (laminar: the slowest mode), behind another one the time
// in which the water passes the box.
#pragma once

#include "driver/case/case.hpp"

namespace thalweg::driver {

enum class FlowCause {
  none,
  slope,
  outlets,
  mean_velocity,
  moving_face,
  inlet,
  initial_fluid,
  moving_grains,
  moving_solids,
  settling
};

// "slope and depth", ...
const char* words_of(FlowCause cause);

struct FlowEstimate {
  double speed = 0.0;                 // m/s, of the fastest fluid; 0: nothing moves it
  FlowCause cause = FlowCause::none;  // of that speed

  // Flow along the bed or a bare floor: of the drives slope (or outlets), mean velocity, moving top and inlet, the one
  // with the largest friction velocity. Undefined without one.
  FlowCause drive = FlowCause::none;
  double way = 1.0;                // along x: 1, -1 to the left; of an oblique flow the cosine, 0 across
  double depth = 0.0;              // m
  double bulk_velocity = 0.0;      // m/s, mean over the depth
  double friction_velocity = 0.0;  // m/s
  bool laminar = false;
  double spin_up = 0.0;        // s
  bool still_gaining = false;  // the run ends before a slope can have brought the flow to its speed
};

// All 0 without a fluid.
FlowEstimate flow_estimate(const Case& c);

// m/s, the largest that a case gives to the surfaces of the grains of a population: at the start, held, or by a rigid
// motion anywhere in their region or the box.
double given_speed(const Case& c, const beds::Population& grains);

// The speed (m/s) that a flow driven along the bed by gravity or outlets can reach, whatever the time of the run. An
// upper estimate, for warnings. 0 without a fluid or such a drive.
double estimated_velocity(const Case& c);

}  // namespace thalweg::driver
