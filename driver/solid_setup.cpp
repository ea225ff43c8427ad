#include "driver/solid_setup.hpp"

#include "core/error.hpp"
#include "io/stl_file.hpp"

#include <fmt/format.h>

namespace thalweg::driver {

std::vector<coupling::SolidShape> solid_shapes(const Case& c) {
  const double spacing = c.domain.spacing;
  std::vector<coupling::SolidShape> shapes;
  for (std::size_t n = 0; n < c.solids.size(); ++n) {
    const SolidCase& solid = c.solids[n];
    if (solid.sphere) {
      shapes.push_back(coupling::SolidSphere{solid.sphere->centre / spacing, {solid.sphere->radius / spacing}});
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

}  // namespace thalweg::driver
