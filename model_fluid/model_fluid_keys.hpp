// Keys of the model fluid (model_fluid.hpp): the section `model_fluid`.
#pragma once

#include "core/keys/section_visitor.hpp"
#include "model_fluid/model_fluid_field.hpp"

#include <optional>
#include <string>

namespace thalweg::model_fluid {

// grain: the mean diameter, the mean mass and the reduced gravity are 1, as in the paper; nothing is converted, but
// this is checked.
enum class ModelUnits { si, grain };

struct ShieldsRampKeys {
  double step = 0.05;                 // relative, of the Shields number
  double every = 0.0;                 // s
  double hold = 0.0;                  // s
  double mobile_share = 1.0;          // of the grains
  double largest_speed = 1e-3;        // v_0
  double largest_acceleration = 0.1;  // g'
  bool operator==(const ShieldsRampKeys&) const = default;
};
void describe(SectionVisitor& visit, ShieldsRampKeys& ramp);

struct ModelFluidKeys {
  double shields_number = 0.0;                  // Theta
  std::optional<double> reynolds_number;        // Re_*, as printed
  std::optional<double> shear_reynolds_number;  // u_* D/nu, physical
  std::optional<ModelDrag> drag;
  double lift_ratio = 0.0;              // F_l/F_d
  double inertial_coefficient = 0.5;    // B_2 D/m
  double fluid_density = 0.0;           // kg/m^3: buoyancy; 0: gravity is the reduced one
  double decay = 5.0;                   // b
  std::optional<double> top_fraction;   // phi_t
  double densest_fraction = 0.7;        // phi_m, of spheres
  std::optional<double> margin;         // m
  double tolerance = 0.01;              // mean diameters
  std::optional<ShieldsRampKeys> ramp;  // else the Shields number is constant
  bool rough_floor = true;
  ModelUnits units = ModelUnits::si;
  bool operator==(const ModelFluidKeys&) const = default;

  ModelFluidNumbers numbers() const;
};

// disks: the grains are disks.
void describe(SectionVisitor& visit, ModelFluidKeys& fluid, bool disks);

// Means over all grains, by number, and the largest of them; a clump is one, with the diameter of the sphere (disk) of
// its volume.
struct MeanGrain {
  double diameter, mass, volume;  // m, kg, m^3
  double largest_diameter;        // m
  double largest_member = 0.0;    // m, diameter of the members of clumps; 0: there are none
  double longest = 0.0;           // m, of clumps
};

// Throws KeyError where units and grains do not fit together. gravity: m/s^2, downwards, without buoyancy.
void check(const ModelFluidKeys& fluid, const MeanGrain& mean, double gravity);

// What m, s and kg of a case in grain units stand for; none in SI units.
std::optional<std::string> units_text(const ModelFluidKeys& fluid);

GrainScales scales_of(const ModelFluidKeys& fluid, const MeanGrain& mean, double gravity);

ModelFluidParameters model_fluid_parameters(const ModelFluidKeys& fluid, const MeanGrain& mean, double gravity,
                                            bool disks);

}  // namespace thalweg::model_fluid
