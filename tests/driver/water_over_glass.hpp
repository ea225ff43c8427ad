// Cases that tests share.
#pragma once

#include "driver/case/case.hpp"

#include <numbers>

namespace thalweg::driver {

// Water over glass spheres (2550 kg/m^3) of diameter d in a box that leaves `depth` above the settled bed.
inline Case water_over_glass(double d, double slope, double depth, double width, lbm::FaceType sides) {
  Case c;
  c.system = SystemKind::resolved;
  c.fluid.density = 1000.0;
  c.fluid.kinematic_viscosity = 1e-6;
  c.fluid.time_step = 2e-5;
  c.gravity.magnitude = 9.8;
  c.gravity.slope = slope;
  beds::Population grains;
  grains.count = 1000;
  grains.diameter = d;
  grains.density = 2550.0;
  c.grains = {grains};
  const double length = 24.0 * d;
  const double fraction = 0.6 * (sides == lbm::FaceType::periodic ? 1.0 : 1.0 - d / (3.0 * width));
  const double bed = 1000.0 * std::numbers::pi / 6.0 * d * d * d / (fraction * length * width);
  c.domain.size = Vec3(length, width, bed + depth);
  c.domain.spacing = 5e-4;
  for (const FaceIndex face : {x_low, x_high}) c.domain.faces[face].type = lbm::FaceType::periodic;
  for (const FaceIndex face : {y_low, y_high}) c.domain.faces[face].type = sides;
  c.domain.faces[top].type = lbm::FaceType::free_slip;
  c.contact.restitution = 0.93;
  c.run.until = 30.0;
  return c;
}

// Holds its grains where a settled bed has them.
inline void hold_bed(Case& c, double depth) {
  c.grains[0].fixed = true;
  c.grains[0].placement.region =
      beds::RegionKeys{Vec3::Zero(), Vec3(c.domain.size.x(), c.domain.size.y(), c.domain.size.z() - depth)};
}

// The case without its grains, and of another viscosity (m^2/s): a film 0.02 m deep over a bare floor.
inline Case film(double viscosity) {
  Case c = water_over_glass(5e-3, 0.016, 0.0412, 0.040, lbm::FaceType::periodic);
  c.grains.clear();
  c.domain.size.z() = 0.02;
  c.fluid.kinematic_viscosity = viscosity;
  return c;
}

// 240 x 80 x 212 cells, 1000 grains of ten cells, periodic along x and y.
inline Case wide_bed() {
  Case c = water_over_glass(5e-3, 0.016, 0.0412, 0.040, lbm::FaceType::periodic);
  c.domain.size = Vec3(0.120, 0.040, 0.106);
  c.coupling.grain_steps_per_fluid_step = 50;
  return c;
}

}  // namespace thalweg::driver
