#include "driver/estimate/stability.hpp"

namespace thalweg::driver {

double stable_lattice_velocity(lbm::CollisionModel collision, double excess) {
  const lbm::CollisionTraits traits = lbm::traits_of(collision);
  for (std::size_t k = 0; k < traits.stable_velocity.size(); ++k)
    if (excess >= lbm::stability_excesses[k]) return traits.stable_velocity[k];
  return 0.0;
}

}  // namespace thalweg::driver
