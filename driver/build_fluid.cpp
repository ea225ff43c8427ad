// From a case to a fluid without grains.
#include "coupling/fluid_system.hpp"
#include "driver/build_system.hpp"
#include "driver/fluid_setup.hpp"
#include "driver/solid_setup.hpp"

namespace thalweg::driver {

namespace {

template <typename Real>
std::unique_ptr<System> build_fluid(const Case& c, MPI_Comm communicator, const Decomposition& cuts) {
  return std::make_unique<coupling::FluidSystem<Real>>(std::make_unique<Decomposition>(cuts), communicator,
                                                       fluid_parameters(c), solid_shapes(c));
}

}  // namespace

std::unique_ptr<System> build_fluid_system(const Case& c, MPI_Comm communicator, const Decomposition& cuts, Start) {
  return c.fluid.precision == coupling::Precision::single ? build_fluid<float>(c, communicator, cuts)
                                                          : build_fluid<double>(c, communicator, cuts);
}

}  // namespace thalweg::driver
