#include "dem/motion/integrator.hpp"

namespace thalweg::dem {

std::vector<NamedChoice<Integrator>> choices_of(Integrator) {
  return {{Integrator::velocity_verlet, "velocity_verlet", ""},
          {Integrator::gear, "gear", "Gear's predictor-corrector of six values"}};
}

}  // namespace thalweg::dem
