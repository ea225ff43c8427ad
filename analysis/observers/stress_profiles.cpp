// Results of a stress balance: means by layers, totals, and their differences from the driving stress.
#include "analysis/observers/stress_balance.hpp"
#include "analysis/tools/tensor_names.hpp"
#include "core/geometry/symmetric_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thalweg::analysis {

namespace {

constexpr int xz = 4;                  // among the components of a symmetric tensor
constexpr int row_xz = 2, row_zx = 6;  // among all nine, row by row

}  // namespace

struct StressBalance::LayerMeans {
  double solid_fraction = 0.0, temperature = 0.0, pressure = 0.0;
  Vec3 grain_velocity = Vec3::Zero(), fluid_velocity = Vec3::Zero(), drag = Vec3::Zero();
  double drag_function = 0.0, drag_reynolds = 0.0;
  std::array<double, 9> contact{}, grain_fluid{}, lubrication{};
  Tensor kinetic{}, viscous{}, subgrid{}, reynolds{}, mean_flow{};
  double rotation = 0.0, contact_rotation = 0.0, sum = 0.0, total = 0.0, sides = 0.0, driving = 0.0;

  double left() const { return driving - sides; }  // by the side walls
};

std::array<double, StressBalance::fluid_columns> StressBalance::fluid_of(int layer) const {
  std::array<double, fluid_columns> sums{};
  for (int z = layers_.first_plane(layer); z < layers_.first_plane(layer + 1); ++z)
    for (std::size_t c = 0; c < fluid_columns; ++c) sums[c] += fluid_[static_cast<std::size_t>(z) * fluid_columns + c];
  return sums;
}

// kg/m^3, of the fluid's cells in the whole box.
double StressBalance::mean_density() const {
  double whole = 0.0, count = 0.0;
  for (std::size_t plane = 0; plane < fluid_.size(); plane += fluid_columns) {
    whole += fluid_[plane + density];
    count += fluid_[plane + cells];
  }
  return whole / count;
}

void StressBalance::set_fluid_means(int layer, LayerMeans& means) const {
  const std::array<double, fluid_columns> sum = fluid_of(layer);
  if (sum[cells] == 0.0) return;
  const double planes = layers_.first_plane(layer + 1) - layers_.first_plane(layer);
  const double unit = 1.0 / (planes * n_[0] * n_[1] * static_cast<double>(measurements()));
  means.pressure = (sum[density] / sum[cells] - mean_density()) * scales_.sound_speed * scales_.sound_speed;
  for (int a = 0; a < 3; ++a) means.fluid_velocity[a] = sum[static_cast<std::size_t>(flow + a)] / sum[density];
  for (std::size_t p = 0; p < 6; ++p) {
    const double carried = sum[static_cast<std::size_t>(flow + symmetric_pairs[p][0])] *
                           sum[static_cast<std::size_t>(flow + symmetric_pairs[p][1])] / sum[density];
    means.reynolds[p] = -unit * (sum[flow_flux + p] - carried);
    means.mean_flow[p] = -unit * carried;
    means.viscous[p] = unit * sum[viscous + p];
    means.subgrid[p] = unit * sum[subgrid + p];
  }
}

void StressBalance::set_grain_means(int layer, LayerMeans& means) const {
  const double* sum = grains_.data() + static_cast<std::size_t>(layer) * grain_columns;
  const double room = n_[0] * n_[1] * spacing_ * spacing_ * layers_.height(layer) * static_cast<double>(measurements());
  means.solid_fraction = sum[volume] / room;
  if (sum[mass] == 0.0) return;
  const Vec3 u = Vec3(sum + momentum) / sum[mass];
  means.grain_velocity = u;
  const double square = (sum[momentum_flux] + sum[momentum_flux + 1] + sum[momentum_flux + 2]) / sum[mass];
  means.temperature = std::max(0.0, (square - u.squaredNorm()) / 3.0);
  means.drag = Vec3(sum + fluid_force) / room;
  for (std::size_t p = 0; p < 6; ++p) {
    const double carried = sum[mass] * u[symmetric_pairs[p][0]] * u[symmetric_pairs[p][1]];
    means.kinetic[p] = -(sum[momentum_flux + p] - carried) / room;
    means.mean_flow[p] -= carried / room;
  }
  for (std::size_t k = 0; k < 9; ++k) {
    means.contact[k] = sum[contact_moment + k] / room;
    means.grain_fluid[k] = sum[fluid_moment + k] / room;
    means.lubrication[k] = sum[lubrication_moment + k] / room;
  }
  means.rotation = means.grain_fluid[row_xz] - means.grain_fluid[row_zx];
  means.contact_rotation = means.contact[row_xz] - means.contact[row_zx];
}

void StressBalance::set_drag_law(LayerMeans& means) const {
  const Vec3 slip = means.fluid_velocity - means.grain_velocity;
  const double phi = means.solid_fraction, fluid = 1.0 - phi, d = scales_.diameter;
  if (phi <= 0.0 || fluid <= 0.0 || slip.x() == 0.0) return;
  means.drag_function = means.drag.x() * d * d / (18.0 * phi * fluid * scales_.viscosity * slip.x());
  means.drag_reynolds = fluid * scales_.fluid_density * slip.norm() * d / scales_.viscosity;
}

// Sum of forces over all that is above a plane, its mean over the planes of a layer; N times measurements. sums: rows
// of layers, with forces and their levers in two of `columns`.
double StressBalance::above(int layer, const std::vector<double>& sums, int columns, int force, int lever) const {
  const auto column = [&](int l, int c) { return sums[static_cast<std::size_t>(l * columns + c)]; };
  double sum = column(layer, lever) / layers_.height(layer);
  for (int l = layer + 1; l < layers_.count(); ++l) sum += column(l, force);
  return sum;
}

double StressBalance::above(int layer, GrainColumn force, GrainColumn lever) const {
  return above(layer, grains_, grain_columns, force, lever);
}

// Sum above a layer of forces recorded at the height at which they act.
double StressBalance::by_height_above(const std::vector<double>& half_planes, int layer) const {
  const double from = layers_.first_plane(layer), planes = layers_.first_plane(layer + 1) - from;
  double sum = 0.0;
  for (std::size_t h = 0; h < half_planes.size(); ++h)
    sum += half_planes[h] * std::clamp((0.5 * static_cast<double>(h) - from) / planes, 0.0, 1.0);
  return sum;
}

// Sum above a layer of the force that drives the fluid.
double StressBalance::driven_above(int layer) const {
  const int from = layers_.first_plane(layer), planes = layers_.first_plane(layer + 1) - from;
  double sum = 0.0;
  for (int z = from; z < n_[2]; ++z)
    sum += driving_[static_cast<std::size_t>(z)] * std::min(1.0, (z - from + 0.5) / planes);
  return sum * spacing_ * spacing_ * spacing_;
}

void StressBalance::set_totals(int layer, LayerMeans& means) const {
  const double area = n_[0] * n_[1] * spacing_ * spacing_ * static_cast<double>(measurements());
  const double carried =
      means.kinetic[xz] + means.viscous[xz] + means.subgrid[xz] + means.reynolds[xz] + means.mean_flow[xz];
  means.sum = carried + means.contact[row_xz] + means.grain_fluid[row_xz] + means.lubrication[row_xz];
  const double walls_on_grains = above(layer, held_up_, 2, 0, 1);
  const double top_on_grains = held_up_[static_cast<std::size_t>(2 * layers_.count())];
  means.total = carried + (by_height_above(given_, layer) - above(layer, fluid_force, fluid_lever) -
                           above(layer, contact_force_x, contact_lever) + walls_on_grains + top_on_grains) /
                              area;
  means.sides = (by_height_above(sides_, layer) - walls_on_grains) / area;
  means.driving =
      (driven_above(layer) + above(layer, outer_force_x, outer_lever) - driving_.back() + top_on_grains) / area;
}

StressBalance::LayerMeans StressBalance::means_of(int layer) const {
  LayerMeans means;
  if (measurements() == 0) return means;
  set_fluid_means(layer, means);
  set_grain_means(layer, means);
  set_drag_law(means);
  set_totals(layer, means);
  return means;
}

std::vector<StressBalance::LayerMeans> StressBalance::all_means() const {
  std::vector<LayerMeans> all;
  for (int layer = 0; layer < layers_.count(); ++layer) all.push_back(means_of(layer));
  return all;
}

// -1: there is no bed, because there are no grains, or because they leave less than a diameter below the top, as in a
// shear cell.
int StressBalance::bed_layer(const std::vector<LayerMeans>& layers) const {
  double densest = 0.0;
  for (const LayerMeans& means : layers) densest = std::max(densest, means.solid_fraction);
  int layer = layers_.count() - 1;
  while (layer >= 0 && (densest == 0.0 || layers[static_cast<std::size_t>(layer)].solid_fraction <= 0.5 * densest))
    --layer;
  const double top = layers_.bottom(layers_.count());
  return layer >= 0 && top - layers_.bottom(layer + 1) < scales_.diameter ? -1 : layer;
}

// At the top of a layer, below which the bed is.
double StressBalance::stress_on_bed(int layer) const {
  const int plane = layers_.first_plane(layer + 1);
  const double cell = spacing_ * spacing_ * spacing_;
  double force = held_up_[static_cast<std::size_t>(2 * layers_.count())] - driving_.back();
  for (int z = plane; z < n_[2]; ++z) force += driving_[static_cast<std::size_t>(z)] * cell;
  for (std::size_t h = static_cast<std::size_t>(2 * plane + 1); h < sides_.size(); ++h) force -= sides_[h];
  for (int l = layer + 1; l < layers_.count(); ++l)
    force += grains_[static_cast<std::size_t>(l * grain_columns + outer_force_x)] +
             held_up_[static_cast<std::size_t>(2 * l)];
  force -= holding_[static_cast<std::size_t>(layer)];
  return force / (n_[0] * n_[1] * spacing_ * spacing_ * static_cast<double>(measurements()));
}

StressBalance::Difference StressBalance::largest_difference(const std::vector<LayerMeans>& layers,
                                                            double LayerMeans::*total, double bed_stress) {
  Difference largest;
  for (std::size_t l = 0; l < layers.size() && bed_stress != 0.0; ++l) {
    const double share = (layers[l].*total + layers[l].sides - layers[l].driving) / bed_stress;
    if (std::abs(share) > std::abs(largest.share)) largest = {share, static_cast<int>(l)};
  }
  return largest;
}

std::vector<Diagnostic> StressBalance::results() const {
  const std::vector<LayerMeans> layers = all_means();
  const int bed = bed_layer(layers);
  double bed_stress = bed >= 0 ? stress_on_bed(bed) : 0.0;
  for (const LayerMeans& means : layers)
    if (bed < 0 && std::abs(means.left()) > std::abs(bed_stress)) bed_stress = means.left();
  const Difference total = largest_difference(layers, &LayerMeans::total, bed_stress);
  const Difference sum = largest_difference(layers, &LayerMeans::sum, bed_stress);
  const auto height = [this](const Difference& d) { return layers_.middle(d.layer); };
  std::vector<Diagnostic> results{{"bed_height", "m", bed >= 0 ? layers_.bottom(bed) + layers_.height(bed) : 0.0},
                                  {"bed_stress", "Pa", bed_stress},
                                  {"largest_difference", "1", total.share},
                                  {"largest_difference_at", "m", height(total)},
                                  {"largest_difference_of_sum", "1", sum.share},
                                  {"largest_difference_of_sum_at", "m", height(sum)}};
  if (measurements() == 0) forget_values(results);
  add_count(results);
  return results;
}

std::vector<std::string> StressBalance::remarks() const {
  if (measurements() == 0) return {"stress balance: nothing was measured"};
  const std::vector<Diagnostic> r = results();
  const bool at_sides = std::any_of(sides_.begin(), sides_.end(), [](double force) { return force != 0.0; });
  const auto value = [&r](const std::string& name) { return find_diagnostic(r, name).value(); };
  const char* where = value("bed_height") > 0.0 ? "on the bed" : "at most";
  return {fmt::format(
      "largest difference of the total stress from the driving stress{}: {:.2g} % of the {:.4g} Pa {}, at z = "
      "{:.4g} m (of the sum of the stresses by volume shares {:.2g} %, at {:.4g} m)",
      at_sides ? " less the share of side walls and solids" : "", 100.0 * value("largest_difference"),
      value("bed_stress"), where, value("largest_difference_at"), 100.0 * value("largest_difference_of_sum"),
      value("largest_difference_of_sum_at"))};
}

std::vector<Profile> StressBalance::profiles() const {
  const std::vector<LayerMeans> layers = all_means();
  const auto n = static_cast<std::uint64_t>(layers.size());
  std::vector<Profile> all;
  const auto add = [&](const char* name, const char* unit, const std::vector<std::string>& components, auto values) {
    Profile profile{name, unit, {"z"}, components, {n}, {}};
    if (!components.empty()) profile.shape.push_back(components.size());
    for (std::size_t l = 0; l < layers.size(); ++l) {
      const auto& of_layer = values(l);
      if constexpr (requires { of_layer.size(); })
        profile.values.insert(profile.values.end(), of_layer.data(), of_layer.data() + of_layer.size());
      else
        profile.values.push_back(of_layer);
    }
    all.push_back(std::move(profile));
  };
  const auto member = [&layers](auto LayerMeans::*which) {
    return [&layers, which ](std::size_t l) -> const auto& { return layers[l].*which; };
  };
  add("z", "m", {}, [this](std::size_t l) { return layers_.middle(static_cast<int>(l)); });
  add("thickness", "m", {}, [this](std::size_t l) { return layers_.height(static_cast<int>(l)); });
  add("solid_fraction", "1", {}, member(&LayerMeans::solid_fraction));
  add("grain_velocity", "m/s", vector_names, member(&LayerMeans::grain_velocity));
  add("fluid_velocity", "m/s", vector_names, member(&LayerMeans::fluid_velocity));
  add("fluid_pressure", "Pa", {}, member(&LayerMeans::pressure));
  add("granular_temperature", "m^2/s^2", {}, member(&LayerMeans::temperature));
  add("drag_density", "N/m^3", vector_names, member(&LayerMeans::drag));
  add("drag_function", "1", {}, member(&LayerMeans::drag_function));
  add("drag_reynolds_number", "1", {}, member(&LayerMeans::drag_reynolds));
  add("contact_stress", "Pa", tensor_names, member(&LayerMeans::contact));
  add("grain_fluid_stress", "Pa", tensor_names, member(&LayerMeans::grain_fluid));
  add("lubrication_stress", "Pa", tensor_names, member(&LayerMeans::lubrication));
  add("kinetic_stress", "Pa", symmetric_names, member(&LayerMeans::kinetic));
  add("viscous_stress", "Pa", symmetric_names, member(&LayerMeans::viscous));
  add("subgrid_stress", "Pa", symmetric_names, member(&LayerMeans::subgrid));
  add("reynolds_stress", "Pa", symmetric_names, member(&LayerMeans::reynolds));
  add("mean_flow_stress", "Pa", symmetric_names, member(&LayerMeans::mean_flow));
  add("rotation_stress", "Pa", {}, member(&LayerMeans::rotation));
  add("contact_rotation_stress", "Pa", {}, member(&LayerMeans::contact_rotation));
  add("sum_of_stresses", "Pa", {}, member(&LayerMeans::sum));
  add("total_stress", "Pa", {}, member(&LayerMeans::total));
  add("side_wall_stress", "Pa", {}, member(&LayerMeans::sides));
  add("driving_stress", "Pa", {}, member(&LayerMeans::driving));
  return all;
}

}  // namespace thalweg::analysis
