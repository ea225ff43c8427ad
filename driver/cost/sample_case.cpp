#include "driver/cost/sample_case.hpp"

#include "beds/files/bed_import.hpp"
#include "core/state/bed.hpp"
#include "dem/laws/contact_laws.hpp"
#include "driver/bed/bed_flow.hpp"
#include "driver/bed/supplied_grains.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace thalweg::driver {

namespace {

// Large enough not to fit into caches, which the whole does not either; and to hold some grains beside each other.
constexpr double most_cells = 1.5e6, most_grains = 4000.0, least_diameters = 8.0;
// Diameters between the centres of neighbours in the bed: each grain touches six others, as many as in a settled bed.
constexpr double between_centres = 0.999;

// Grains that the box holds in the mean of the run.
double mean_count(const Case& c) { return mean_growth(c) * static_cast<double>(grain_count(c)); }

// Length of the box along x, m.
double length_of(const Case& c) {
  const Index3 n = cells_of(c.domain);
  double share = 1.0;
  if (has_fluid(c)) share = std::min(share, most_cells / (static_cast<double>(n[0]) * n[1] * n[2]));
  if (!c.grains.empty()) share = std::min(share, most_grains / mean_count(c));
  const double least = std::max(least_diameters * largest_diameter(c), 4.0 * c.domain.spacing);
  const double length = std::max(share * c.domain.size.x(), least);
  return std::min(c.domain.size.x(), std::round(length / c.domain.spacing) * c.domain.spacing);
}

// Diameters of all grains (m), one in `stride`, or several times as many; those of a bed file from small to large.
std::vector<double> some_diameters(const Case& c, double stride) {
  std::vector<double> diameters;
  double next = 0.5 * stride, number = 0.0;
  const auto add = [&](std::int64_t count, const auto& diameter_of) {
    for (std::int64_t grain = 0; grain < count; ++grain, ++number)
      for (; next < number + 1.0; next += stride) diameters.push_back(diameter_of(static_cast<std::size_t>(grain)));
  };
  for (const beds::Population& population : c.grains) {
    if (!population.from_file())
      add(population.count, [&](std::size_t grain) { return population.diameter_of(grain); });
    for (const beds::SizeCount& size : population.figures.sizes)
      add(size.count, [&](std::size_t) { return size.diameter; });
  }
  if (diameters.empty()) diameters.push_back(c.grains.front().diameter);
  return diameters;
}

// Grains on a cubic lattice from the floor up, as far as there is room.
std::vector<BedGrain> bed_of(const std::vector<double>& diameters, double density, bool disks, const Vec3& size) {
  const double spacing = between_centres * *std::max_element(diameters.begin(), diameters.end());
  const auto across = [&](int axis) { return std::max(1, static_cast<int>(size[axis] / spacing)); };
  const int nx = across(0), ny = disks ? 1 : across(1), nz = across(2);
  std::vector<BedGrain> bed;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx && bed.size() < diameters.size(); ++i) {
        BedGrain grain;
        grain.id = static_cast<GlobalId>(bed.size());
        grain.radius = 0.5 * diameters[bed.size()];
        grain.density = density;
        grain.position = spacing * Vec3(i + 0.5, j + 0.5, k + 0.5);
        if (disks) grain.position.y() = 0.5 * size.y();
        bed.push_back(grain);
      }
  return bed;
}

beds::Population grains_of(const Case& c, const Vec3& size, double share) {
  const model_fluid::MeanGrain mean = mean_grain(c);
  std::vector<double> diameters = some_diameters(c, 1.0 / (share * mean_growth(c)));
  beds::Population grains;
  grains.density = mean.mass / mean.volume;
  grains.fixed = !has_free_grains(c);
  grains.thickness = c.disks ? c.disks->thickness : 0.0;
  if (settled_height(c) > 0.0) {
    grains.placement.file = "a sample";
    take_rows(grains, bed_of(diameters, grains.density, c.disks.has_value(), size), {size, periodic_axes(c.domain)},
              {});
    return grains;
  }
  grains.placement.pattern = beds::PlacementPattern::dense;
  grains.count = static_cast<std::int64_t>(diameters.size());
  grains.diameter = beds::median_by_mass(beds::counted(diameters), c.disks.has_value());
  grains.diameters = std::move(diameters);
  return grains;
}

// Softens the contacts of the sample as far as the step of the case requires: its grains have all sizes, also of those
// that the case holds, but one density and one material.
void suit_contacts_to_step(Case& s) {
  constexpr double margin = 0.99;
  const double step = grain_time_step(s), faster = margin * longest_contact_step(s) / step;
  if (faster < margin) {  // the stiffness by a power, the dashpot by its root: the restitution stays
    dem::with_spring_law(s.contact.law, [&](auto spring) {
      using Spring = typename decltype(spring)::type;
      s.contact.*Spring::stiffness *= std::pow(faster, Spring::impacts_per_stiffness);
    });
    s.contact.tangential_stiffness *= faster * faster;
    if (s.contact.damping) *s.contact.damping *= faster;
  }
  if (const double longest = longest_lubrication_step(s); step > longest)
    s.coupling.lubrication->minimum_gap *= step / longest / margin;
}

}  // namespace

Sample sample_of(const Case& c) {
  Sample sample{c, 1.0, 1.0};
  Case& s = sample.c;
  s.domain.size.x() = length_of(c);
  sample.share = s.domain.size.x() / c.domain.size.x();
  for (const int face : {x_low, x_high})
    s.domain.faces[static_cast<std::size_t>(face)] = {.type = lbm::FaceType::periodic};
  s.grains.clear();
  s.supplies.clear();
  s.sinks.clear();
  s.walls.clear();
  s.solids.clear();
  s.contact.walls.reset();
  s.initial = {};
  s.run.until_at_rest.reset();
  if (c.grains.empty()) return sample;
  s.grains.push_back(grains_of(c, s.domain.size, sample.share));
  sample.share_of_grains = static_cast<double>(s.grains.front().count) / mean_count(c);
  suit_contacts_to_step(s);
  return sample;
}

}  // namespace thalweg::driver
