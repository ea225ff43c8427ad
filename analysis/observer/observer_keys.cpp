#include "analysis/observer/observer_keys.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace thalweg::analysis {

void describe_from(SectionVisitor& visit, double& from) {
  visit.real("from", from, {.unit = "s", .meaning = "start of the means", .at_least = 0.0});
}

void describe_every(SectionVisitor& visit, double& every) {
  visit.real("every", every, {.unit = "s", .meaning = "between measurements", .above = 0.0});
}

void require_grains(const RunContext& run, const std::string& what) {
  if (!run.grains) throw KeyError("", fmt::format("there are no grains to {}; remove the section or add grains", what));
}

void require_ids(const RunContext& run, const std::vector<GlobalId>& ids) {
  require_grains(run, "watch");
  const GlobalId count = run.grains->count();
  for (std::size_t n = 0; n < ids.size(); ++n) {
    const std::string key = fmt::format("grains.{}", n);
    if (ids[n] >= count)
      throw KeyError(key, fmt::format("there is no grain {}; give ids from 0 to {}", ids[n], count - 1));
    const auto here = ids.begin() + static_cast<std::ptrdiff_t>(n);
    if (std::find(ids.begin(), here, ids[n]) != here)
      throw KeyError(key, fmt::format("grain {} is named twice; give each id once", ids[n]));
  }
}

void require_full_gravity_from(const RunContext& run, double from) {
  if (from < run.ramp)
    throw KeyError(
        "from", fmt::format("{} s is before gravity has its full value; give at least run.ramp, {} s", from, run.ramp));
}

void require_layer_in_box(const RunContext& run, const std::optional<double>& layer) {
  const double height = run.box.size.z();
  if (layer && *layer > height * (1.0 + 1e-9))
    throw KeyError("layer", fmt::format("a layer is no higher than the box; give at most {:g} m", height));
}

void require_fine_pixel(const RunContext& run, const std::optional<double>& pixel) {
  constexpr double fewest_across_a_grain = 4.0;
  const double widest = run.grains->reference_diameter / fewest_across_a_grain;
  if (pixel && *pixel > widest * (1.0 + 1e-9))
    throw KeyError("pixel", fmt::format("the surface of the bed needs at least {:g} pixels across a grain of {:g} m; "
                                        "give at most {:.6g} m, or leave the key out",
                                        fewest_across_a_grain, run.grains->reference_diameter, widest));
}

}  // namespace thalweg::analysis
