// A column of the two-phase continuum, from a case.
#include "continuum/continuum_system.hpp"
#include "driver/setup/build_system.hpp"

namespace thalweg::driver {

std::unique_ptr<System> build_continuum_system(const Case& c, MPI_Comm communicator, const Decomposition&, Start) {
  return std::make_unique<continuum::ContinuumSystem>(communicator, column_of(c));
}

}  // namespace thalweg::driver
