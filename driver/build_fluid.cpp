// From a case to a fluid without grains.
#include "core/error.hpp"
#include "coupling/fluid_system.hpp"
#include "driver/build_system.hpp"
#include "driver/fluid_setup.hpp"
#include "io/stl_file.hpp"

#include <fmt/format.h>

namespace thalweg::driver {

namespace {

// The solids of the case in lattice units.
std::vector<coupling::SolidShape> solid_shapes(const Case& c) {
  const double spacing = c.domain.spacing;
  std::vector<coupling::SolidShape> shapes;
  for (std::size_t n = 0; n < c.solids.size(); ++n) {
    const SolidCase& solid = c.solids[n];
    if (solid.sphere) {
      shapes.push_back(coupling::SolidSphere{solid.sphere->centre / spacing, solid.sphere->radius / spacing});
      continue;
    }
    try {
      TriangleMesh mesh = io::read_stl(solid.stl);
      for (Vec3& point : mesh.points) point = (point * solid.scale + solid.translate) / spacing;
      shapes.push_back(std::move(mesh));
    } catch (const InputError& error) {
      throw InputError(fmt::format("solids.{}.stl: {}", n, error.what()));
    }
  }
  return shapes;
}

template <typename Real>
std::unique_ptr<System> build(const Case& c, MPI_Comm communicator, const Index3& layout) {
  return std::make_unique<coupling::FluidSystem<Real>>(std::make_unique<Decomposition>(decomposition_of(c, layout)),
                                                       communicator, fluid_parameters(c), solid_shapes(c));
}

}  // namespace

std::unique_ptr<System> build_fluid_system(const Case& c, MPI_Comm communicator, const Index3& layout) {
  return c.fluid.precision == Precision::single ? build<float>(c, communicator, layout)
                                                : build<double>(c, communicator, layout);
}

}  // namespace thalweg::driver
