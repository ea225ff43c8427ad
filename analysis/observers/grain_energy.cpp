#include "analysis/observers/grain_energy.hpp"

#include "core/sums/reproducible_sum.hpp"

namespace thalweg::analysis {

void GrainEnergy::observe(const Snapshot& snapshot) {
  const GrainView& grains = snapshot.grains;
  constexpr std::size_t columns = 4;
  std::vector<double> terms;
  terms.reserve(grains.id.size() * columns);
  const auto add = [&terms](double energy, double mass, const Vec3& velocity) {
    terms.insert(terms.end(), {energy, mass * velocity[0], mass * velocity[1], mass * velocity[2]});
  };
  for (std::size_t i = 0; i < grains.id.size(); ++i) {
    if (grains.is_member(i)) continue;
    const double mass = grains.mass[i];
    const double inertia = (grains.disk_thickness > 0.0 ? 0.5 : 0.4) * mass * grains.radius[i] * grains.radius[i];
    add(0.5 * mass * grains.velocity[i].squaredNorm() + 0.5 * inertia * grains.angular_velocity[i].squaredNorm(), mass,
        grains.velocity[i]);
  }
  for (const ClumpState& clump : grains.clumps) add(clump.kinetic_energy, clump.mass, clump.velocity);
  const std::vector<double> sums = reproducible_sums(communicator_, terms, columns);
  for (std::size_t n = 0; n < columns; ++n) diagnostics_[n].value = sums[n];
}

}  // namespace thalweg::analysis
