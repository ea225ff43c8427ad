#include "analysis/grain_energy.hpp"

#include "core/order_free_sum.hpp"

namespace thalweg::analysis {

void GrainEnergy::observe(const Snapshot& snapshot) {
  const GrainView& grains = snapshot.grains;
  constexpr std::size_t columns = 4;
  std::vector<double> terms(grains.id.size() * columns);
  for (std::size_t i = 0; i < grains.id.size(); ++i) {
    const double mass = grains.mass[i];
    const double inertia = (grains.disk_thickness > 0.0 ? 0.5 : 0.4) * mass * grains.radius[i] * grains.radius[i];
    terms[i * columns] =
        0.5 * mass * grains.velocity[i].squaredNorm() + 0.5 * inertia * grains.angular_velocity[i].squaredNorm();
    for (int axis = 0; axis < 3; ++axis) terms[i * columns + 1 + axis] = mass * grains.velocity[i][axis];
  }
  const std::vector<double> sums = order_free_sums(communicator_, terms, columns);
  energy_ = sums[0];
  momentum_ = Vec3(sums[1], sums[2], sums[3]);
}

std::vector<Figure> GrainEnergy::figures() const {
  return {{"grain_kinetic_energy", "J", energy_},
          {"grain_momentum_x", "kg m/s", momentum_.x()},
          {"grain_momentum_y", "kg m/s", momentum_.y()},
          {"grain_momentum_z", "kg m/s", momentum_.z()}};
}

}  // namespace thalweg::analysis
