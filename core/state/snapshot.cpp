#include "core/state/snapshot.hpp"

#include <stdexcept>

namespace thalweg {

const std::vector<double>& values_of(const FluidFields& fields, FluidField field) {
  switch (field) {
    case FluidField::velocity:
      return fields.velocity;
    case FluidField::pressure:
      return fields.pressure;
    case FluidField::density:
      return fields.density;
    case FluidField::shear_rate:
      return fields.shear_rate;
    case FluidField::eddy_viscosity:
      return fields.eddy_viscosity;
    case FluidField::vorticity:
      return fields.vorticity;
    case FluidField::q_criterion:
      return fields.q_criterion;
    case FluidField::grain_id:
      break;
  }
  throw std::logic_error("a fluid field without real values");
}

std::vector<double>& values_of(FluidFields& fields, FluidField field) {
  return const_cast<std::vector<double>&>(values_of(static_cast<const FluidFields&>(fields), field));
}

}  // namespace thalweg
