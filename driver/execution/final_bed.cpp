#include "driver/execution/final_bed.hpp"

#include "analysis/observers/bed_surface.hpp"
#include "driver/bed/bed_flow.hpp"
#include "driver/input/run_context.hpp"

#include <fmt/format.h>

#include <cmath>

namespace thalweg::driver {

std::vector<Diagnostic> final_bed(MPI_Comm communicator, const Case& c, const System& system) {
  const Snapshot snapshot = system.snapshot();
  if (snapshot.grains.global_count == 0 || periodic_axes(c.domain)[2]) return {};
  const auto surface = make_observer(analysis::BedSurfaceKeys{}, run_context(c),
                                     {communicator, *snapshot.decomposition, system.time_step()});
  surface->observe(snapshot);
  std::vector<Diagnostic> bed;
  for (const Diagnostic& diagnostic : surface->diagnostics())
    if (!std::isnan(diagnostic.value)) bed.push_back(diagnostic);  // no pixel is known to be static after one look
  const double fraction = find_diagnostic(surface->results(), "bulk_solid_fraction_mean").value_or(0.0);
  bed.insert(bed.begin() + 1, {"porosity", "1", 1.0 - fraction});
  if (fraction < loosest_bed) bed.resize(2);
  // What obstacles take above the bed is known in steps for which it was asked (BedSurface::needs_momentum()).
  if (surface->needs_momentum())
    std::erase_if(bed, [](const Diagnostic& d) { return d.name == "bed_stress" || d.name == "shields_number"; });
  return bed;
}

std::string final_bed_text(const std::vector<Diagnostic>& bed) {
  if (bed.empty()) return {};
  const auto value = [&bed](const char* name) { return find_diagnostic(bed, name); };
  if (*value("porosity") > 1.0 - loosest_bed)
    return fmt::format("no bed at the end: the grains below {:.4g} m have a porosity of {:.3g}", *value("bed_height"),
                       *value("porosity"));
  std::string text = fmt::format("bed: {:.4g} m high, porosity {:.3g}", *value("bed_height"), *value("porosity"));
  if (const auto depth = value("flow_depth")) text += fmt::format("; {:.4g} m of flow above it", *depth);
  if (const auto stress = value("bed_stress"))
    text +=
        fmt::format("; bed stress {:.4g} Pa, Shields number {:.4g}", *stress, value("shields_number").value_or(0.0));
  return text + " (at the end)";
}

}  // namespace thalweg::driver
