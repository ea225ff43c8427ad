// The grains whose contacts are shortest, which the time step of a run must resolve.
#pragma once

#include "core/parallel/mpi_session.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace thalweg::dem {

// The least mass (kg) and radius (m) of the grains of a material that are free to move: their contacts are shortest;
// and the largest radius over mass (m/kg), of the grain that a viscous fluid slows fastest. (For a contact of two
// materials, m*/k lies between the values within each, since springs add in series as masses do.)
struct LightestGrain {
  double mass = std::numeric_limits<double>::infinity();
  double radius = std::numeric_limits<double>::infinity();
  double squared_mass_per_radius = std::numeric_limits<double>::infinity();  // kg^2/m: least
  double radius_per_mass = 0.0;

  void include(double other_mass, double other_radius) {
    mass = std::min(mass, other_mass);
    radius = std::min(radius, other_radius);
    squared_mass_per_radius = std::min(squared_mass_per_radius, other_mass * other_mass / other_radius);
    radius_per_mass = std::max(radius_per_mass, other_radius / other_mass);
  }

  // Radius (m) of a grain of the least mass whose Hertzian contacts are as short as the shortest: their time goes with
  // the fifth root of m^2/R, which may be least for a heavier but larger grain.
  double hertzian_radius() const {
    return mass * mass / radius > squared_mass_per_radius ? mass * mass / squared_mass_per_radius : radius;
  }
};

// Combines the lightest grains of all ranks, by material. Collective.
inline void share_over_ranks(MPI_Comm communicator, std::vector<LightestGrain>& lightest) {
  for (LightestGrain& grain : lightest)
    grain = {-max_over_ranks(communicator, -grain.mass), -max_over_ranks(communicator, -grain.radius),
             -max_over_ranks(communicator, -grain.squared_mass_per_radius),
             max_over_ranks(communicator, grain.radius_per_mass)};
}

}  // namespace thalweg::dem
