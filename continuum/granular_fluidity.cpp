#include "continuum/granular_fluidity.hpp"

#include "core/base/error.hpp"

#include <fmt/format.h>
#include <Eigen/SparseLU>

#include <algorithm>
#include <cmath>

namespace thalweg::continuum {

namespace {

constexpr int most_iterations = 50;
constexpr double smallest_correction = 1e-12;  // relative to the fluidity at the upper end

// Coefficients of g and g^2 on the right.
struct Reaction {
  std::vector<double> linear, quadratic;
};

Reaction reaction_of(const Rheology& rheology, const Mixture& mixture, double rate_coefficient,
                     const BedStress& stress) {
  Reaction reaction;
  for (std::size_t i = 0; i < stress.pressure.size(); ++i) {
    const double mu = stress.ratio(i);
    if (!(mu < rheology.limit_friction))
      throw InputError(
          fmt::format("Creep has no steady state where the stress ratio of the grains, here {:.3g}, is not "
                      "below {:g}; begin deeper below the surface.",
                      mu, rheology.limit_friction));
    reaction.linear.push_back((rheology.limit_friction - rheology.static_friction) * (rheology.static_friction - mu) /
                              (rheology.limit_friction - mu));
    reaction.quadratic.push_back(rate_coefficient * mixture.diameter *
                                 std::sqrt(mixture.grain_density / stress.pressure[i]) * mu);
  }
  return reaction;
}

// Corrects g between the ends by one Newton step; returns the largest correction.
double correct(std::vector<double>& g, const Reaction& reaction, double diffusion) {
  const int inner = static_cast<int>(g.size()) - 2;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd residual(inner);
  for (int row = 0; row < inner; ++row) {
    const auto i = static_cast<std::size_t>(row) + 1;
    residual[row] =
        diffusion * (g[i - 1] - 2.0 * g[i] + g[i + 1]) - (reaction.linear[i] + reaction.quadratic[i] * g[i]) * g[i];
    entries.emplace_back(row, row, -2.0 * diffusion - reaction.linear[i] - 2.0 * reaction.quadratic[i] * g[i]);
    if (row > 0) entries.emplace_back(row, row - 1, diffusion);
    if (row + 1 < inner) entries.emplace_back(row, row + 1, diffusion);
  }
  Eigen::SparseMatrix<double> jacobian(inner, inner);
  jacobian.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(jacobian);
  const Eigen::VectorXd correction = solver.solve(residual);
  for (int row = 0; row < inner; ++row) g[static_cast<std::size_t>(row) + 1] -= correction[row];
  return correction.cwiseAbs().maxCoeff();
}

}  // namespace

double local_rate_coefficient(const Rheology& rheology) {
  return (rheology.limit_friction - rheology.static_friction) / rheology.friction_scale;
}

Creep creep_of(const Rheology& rheology, const Mixture& mixture, double nonlocal_amplitude, double rate_coefficient,
               const BedStress& stress, double surface_fluidity) {
  const std::size_t points = stress.pressure.size();
  if (points < 3) throw InputError("Creep needs at least three points between its ends.");
  const Reaction reaction = reaction_of(rheology, mixture, rate_coefficient, stress);
  const double length = nonlocal_amplitude * mixture.diameter / stress.spacing;
  Creep creep;
  creep.fluidity.assign(points, 0.0);
  creep.fluidity.back() = surface_fluidity;
  double correction = surface_fluidity;
  for (int n = 0; n < most_iterations && correction > smallest_correction * surface_fluidity; ++n)
    correction = correct(creep.fluidity, reaction, length * length);
  if (!(correction <= smallest_correction * surface_fluidity))
    throw RunError("The fluidity of the bed was not found: Newton's method did not converge.");
  if (*std::min_element(creep.fluidity.begin(), creep.fluidity.end()) < 0.0)
    throw InputError(
        "Creep has no steady state here with the fluidity that is given at the upper end; begin deeper below "
        "the surface, or give a larger creep.surface_fluidity.");
  creep.grain_velocity.assign(points, 0.0);
  for (std::size_t i = 1; i < points; ++i)
    creep.grain_velocity[i] =
        creep.grain_velocity[i - 1] +
        0.5 * stress.spacing * (creep.fluidity[i - 1] * stress.ratio(i - 1) + creep.fluidity[i] * stress.ratio(i));
  return creep;
}

double decay_length(const Creep& creep, double spacing, std::size_t first) {
  double n = 0.0, z = 0.0, y = 0.0, zz = 0.0, zy = 0.0;
  for (std::size_t i = std::max<std::size_t>(first, 1); i < creep.grain_velocity.size(); ++i) {
    const double height = static_cast<double>(i) * spacing, value = std::log(creep.grain_velocity[i]);
    n += 1.0;
    z += height;
    y += value;
    zz += height * height;
    zy += height * value;
  }
  return (n * zz - z * z) / (n * zy - z * y);
}

BedStress resting_bed(const Rheology& rheology, const Mixture& mixture, double gravity_x, double gravity_z,
                      double bed_stress, double lower, double upper, int points) {
  const double phi = rheology.densest_fraction;
  const double density = phi * mixture.grain_density + (1.0 - phi) * mixture.fluid_density;
  BedStress stress;
  stress.spacing = (lower - upper) / (points - 1);
  for (int i = 0; i < points; ++i) {
    const double depth = lower - i * stress.spacing;
    stress.pressure.push_back(phi * mixture.excess_density() * gravity_z * depth);
    stress.shear_stress.push_back(bed_stress + density * gravity_x * depth);
  }
  return stress;
}

}  // namespace thalweg::continuum
