#include "lbm/collision/subgrid.hpp"

namespace thalweg::lbm {

std::vector<NamedChoice<SubgridModel>> choices_of(SubgridModel) {
  return {{SubgridModel::qr, "qr", "the least eddy viscosity, none in simple shear (Verstappen)"},
          {SubgridModel::smagorinsky, "smagorinsky", "with smagorinsky_constant, as published"},
          {SubgridModel::none, "none", "for laminar flow"}};
}

}  // namespace thalweg::lbm
