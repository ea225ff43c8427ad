// The channel that a case makes of its box, bed and walls, and the log law of the flow in it.
//
// A flow along the bed has the depth H from the settled bed to the top. Where the top drags it, each of the two
// surfaces has half of it: h = H/2, else h = H; R is the hydraulic radius, from h and the side walls.
//
// z_0: d/15 over grains (equivalent roughness of two diameters), nu/(9 u_tau) over a bare floor.
#pragma once

#include "driver/case/case.hpp"
#include "driver/estimate/laminar_channel.hpp"

namespace thalweg::driver {

inline constexpr double roughness_a_diameter = 15.0;  // d/z_0
inline constexpr double smooth_wall_number = 9.0;     // nu/(u_tau z_0) of a bare floor or wall

// z_0 (m) of a bare floor: nu/(9 u_tau), of m^2/s and m/s.
constexpr double smooth_roughness(double viscosity, double friction_velocity) {
  return viscosity / (smooth_wall_number * friction_velocity);
}

struct Channel {
  double depth;       // m, H
  double reach;       // m, h; infinite where neither floor nor top holds the flow
  double half_width;  // m, to the middle between two side walls, the whole width beside one; infinite without
  double roughness;   // m, z_0 over grains; 0: a bare floor
  double viscosity;   // m^2/s
  double radius;      // m, R; h without side walls

  bool is_held() const;

  // m, in the log law: the reach; the half-width without floor and top; the depth without any wall.
  double distance() const;

  // ln(distance/z_0), at least 1 so that a flow as deep as its roughness has a velocity. In m and m/s.
  double log_of(double distance, double friction_velocity) const;

  // The laminar flow that this acceleration (m/s^2) drives; without any wall, that of a film.
  LaminarChannel laminar(double acceleration) const;
};
Channel channel_of(const Case& c);

// True where held grains leave no room above them.
bool held_grains_fill(const Case& c);

}  // namespace thalweg::driver
