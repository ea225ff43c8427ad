// `thalweg new`: a complete case from what an experimenter knows. Spacing, step, contacts, start, duration and
// averaging window are solved for together, until check has no warning.
#pragma once

#include <filesystem>
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
  double fluid_density = 1000.0;                       // kg/m^3
  double viscosity = 1e-6;                             // m^2/s
  double gravity = 9.81;                               // m/s^2
  std::optional<double> shields_number, slope, depth;  // 1, 1 (tangent), m of water above the bed
  std::optional<double> width;  // m, between side walls; else the box is periodic across the stream
  double layers = 5.0;          // of grains in the bed, in diameters
  Accuracy accuracy = Accuracy::look;
  int cores = 1;
  std::optional<double> hours;  // at hand
};

// "0.002:0,0.004:0.5,0.008:1": sieves in m and the share of the mass that passes each. Throws InputError.
std::vector<SievePoint> parse_sieve(const std::string& text);

// Writes the case and returns what to say of it: its size and cost, what follows from the flow, what the accuracy
// leaves. Throws InputError, and leaves no file, where the experiment lacks a number, contradicts itself, cannot be (a
// bed that would slide), or takes more than the hours at hand even in the smallest box; and where the file exists.
// bandwidth: bytes/s of one core's memory.
std::vector<std::string> write_new_case(const Experiment& experiment, const std::filesystem::path& path,
                                        double bandwidth);

}  // namespace thalweg::driver
