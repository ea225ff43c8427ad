#include "coupling/system/imported_fluid.hpp"

#include "core/base/error.hpp"
#include "lbm/fluid/flow_transfer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thalweg::coupling {

template <typename Real>
double import_fluid(lbm::Fluid<Real>& fluid, ArchiveReader& archive, double spacing,
                    const FluidParameters& parameters) {
  const Units& units = parameters.units;
  const Index3& here = fluid.decomposition().cells();
  const std::vector<std::uint64_t> saved = archive.shape("fluid/populations_00");
  bool same_cells = spacing == units.spacing;
  for (int a = 0; a < 3; ++a) {
    const auto cells = static_cast<double>(saved.at(static_cast<std::size_t>(2 - a)));
    same_cells = same_cells && cells == here[a];
    const double saved_length = cells * spacing, length = here[a] * units.spacing;
    if (std::abs(saved_length - length) > std::max(spacing, units.spacing))
      throw InputError(
          fmt::format("its box is {:.6g} m long along {}, but here it is {:.6g} m; use the same domain.size.",
                      saved_length, "xyz"[a], length));
  }
  const double saved_step = archive.real_attribute("system/time_step");
  const double velocity_unit = spacing / saved_step / units.velocity();
  fluid.begin_control_of(archive, velocity_unit * units.time_step / saved_step);
  if (same_cells && saved_step == units.time_step) {
    fluid.load_populations(archive);
    return 1.0;
  }
  lbm::transfer_flow(fluid, archive, velocity_unit);
  return velocity_unit * velocity_unit;
}

template double import_fluid(lbm::Fluid<float>&, ArchiveReader&, double, const FluidParameters&);
template double import_fluid(lbm::Fluid<double>&, ArchiveReader&, double, const FluidParameters&);

}  // namespace thalweg::coupling
