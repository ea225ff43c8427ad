// What an experimenter knows, as the options of `thalweg new`, and what is refused of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace thalweg::driver {

enum class Accuracy { look, measure, publish };

struct SievePoint {
  double size = 0.0;   // m
  double finer = 0.0;  // 1, share of the mass
};

// Two of Shields number, slope and depth say what flows.
struct Experiment {
  std::optional<double> diameter;                      // m; or ...
  std::vector<SievePoint> sieve;                       // ... a grading curve
  double density = 2650.0;                             // kg/m^3, of the grains
  std::optional<double> given_fluid_density;           // kg/m^3; that of water where none is given
  double viscosity = 1e-6;                             // m^2/s
  double gravity = 9.81;                               // m/s^2
  std::optional<double> shields_number, slope, depth;  // 1, 1 (tangent), m of water above the bed
  std::optional<double> width;                         // m, between side walls; else the box is periodic across it
  std::optional<double> length, periodic_width;        // m, of the periodic box
  double layers = 5.0;                                 // of grains in the bed, in diameters
  Accuracy accuracy = Accuracy::look;
  int cores = 1;
  std::optional<double> hours;  // at hand

  double fluid_density() const { return given_fluid_density.value_or(1000.0); }
};

// m, of the grains of an experiment.
struct GrainSizes {
  double smallest, median, largest;
};
GrainSizes sizes_of(const Experiment& experiment);

// "0.002:0,0.004:0.5,0.008:1": sieves in m and the share of the mass that passes each. Throws InputError.
std::vector<SievePoint> parse_sieve(const std::string& text);

// Throws InputError, in the words of the options, where the experiment lacks a number, contradicts itself, has a flow
// or a box that cannot be, or a number that is probably in another unit.
void check_experiment(const Experiment& experiment);

}  // namespace thalweg::driver
