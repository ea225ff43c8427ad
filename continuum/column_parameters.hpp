// Parameters of a two-phase column.
#pragma once

#include "continuum/drag.hpp"
#include "continuum/granular_rheology.hpp"
#include "continuum/mixture.hpp"
#include "continuum/turbulence.hpp"

#include <cmath>

namespace thalweg::continuum {

// Sign of the drift velocity. As printed, f_d has U_s - U_f + u_d, which carries grains up their own gradient.
enum class DriftSign { diffusive, printed };
std::vector<NamedChoice<DriftSign>> choices_of(DriftSign);

// The velocity difference in the Reynolds number of the drag.
enum class DragSpeed { total, streamwise };
std::vector<NamedChoice<DragSpeed>> choices_of(DragSpeed);

struct Closures {
  Rheology rheology;
  Turbulence turbulence;
  Drag drag;
  DragSpeed speed = DragSpeed::total;
  DriftSign drift = DriftSign::diffusive;
  bool operator==(const Closures&) const = default;
};

struct ColumnParameters {
  Mixture mixture;
  Closures closures;
  double gravity_x = 0.0, gravity_z = 0.0;  // m/s^2: along the bed, downwards into it
  int cells = 0;
  double spacing = 0.0;  // m

  double height() const { return cells * spacing; }                                             // m
  double shear_speed() const { return mixture.shear_speed(std::hypot(gravity_x, gravity_z)); }  // m/s
};

}  // namespace thalweg::continuum
