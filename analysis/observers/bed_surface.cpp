#include "analysis/observers/bed_surface.hpp"

#include "analysis/observer/mean_observer.hpp"
#include "core/base/ramp.hpp"
#include "core/geometry/hydraulic_radius.hpp"
#include "core/state/whole_dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace thalweg::analysis {

namespace {

const std::string static_height = "static_bed_height";

// Mean height of the columns that have a static pixel; not a number if none has.
double mean_height(const std::vector<double>& surface) {
  const auto columns = static_cast<double>(std::count_if(surface.begin(), surface.end(), StaticPixels::is_static));
  return std::accumulate(surface.begin(), surface.end(), 0.0) / columns;
}

bool is_stress(const Diagnostic& diagnostic) {
  return diagnostic.name == "bed_stress" || diagnostic.name == "shields_number";
}

// The mean of each column over the pictures that show a static pixel in it; 0 where none does.
std::vector<double> means_of(const std::vector<double>& sums, const std::vector<double>& counts) {
  std::vector<double> means;
  for (std::size_t c = 0; c < sums.size(); ++c) means.push_back(sums[c] / std::max(1.0, counts[c]));
  return means;
}

}  // namespace

// diameter: m, the reference one.
static StaticPixels pixels_of(MPI_Comm communicator, const PeriodicBox& box, const BedSurfaceKeys& keys,
                              double diameter) {
  return {communicator, box, keys.pixel.value_or(diameter / 25.0), keys.static_time};
}

BedSurface::BedSurface(MPI_Comm communicator, const PeriodicBox& box, const BedSurfaceKeys& keys, double diameter,
                       const std::optional<BedFlow>& flow, double disk_thickness, const BedObstacles& obstacles)
    : communicator_(communicator),
      box_(box),
      keys_(keys),
      flow_(flow),
      diameter_(diameter),
      layers_(communicator, box, keys.layer.value_or(diameter), disk_thickness, obstacles),
      pixels_(pixels_of(communicator, box, keys, diameter)),
      surface_sums_(static_cast<std::size_t>(pixels_.columns()), 0.0),
      surface_counts_(surface_sums_) {
  sums_.assign(diagnostics().size(), 0.0);
}

void BedSurface::observe(const Snapshot& snapshot) {
  // A restarted run measures the state of its checkpoint once more.
  const bool again = snapshot.step <= seen_step_;
  measure(snapshot);
  if (again) return;
  seen_step_ = snapshot.step;
  if (pixels_.look(snapshot, layers_.not_of_the_bed(snapshot)) && counts_from(keys_.from, pixels_.begun())) {
    ++pictures_;
    for (std::size_t c = 0; c < surface_sums_.size(); ++c) {
      surface_sums_[c] += pixels_.surface()[c];
      surface_counts_[c] += StaticPixels::is_static(pixels_.surface()[c]) ? 1.0 : 0.0;
    }
  }
  if (!counts_from(keys_.from, snapshot.time)) return;
  const bool has_stress = !lacks_momentum(snapshot);
  ++measurements_;
  if (has_stress) ++stresses_;
  std::size_t n = 0;
  for (const Diagnostic& diagnostic : diagnostics())
    if (diagnostic.name != static_height) sums_[n++] += has_stress || !is_stress(diagnostic) ? diagnostic.value : 0.0;
  sums_[n] += bulk_;
}

// A state that was loaded has not recorded it; at the start nothing has been given to a body yet.
bool BedSurface::lacks_momentum(const Snapshot& snapshot) const {
  return needs_momentum() && snapshot.momentum == nullptr && snapshot.step > 0;
}

double BedSurface::taken_by_obstacles(const Snapshot& snapshot, const FluidSource::Drive& drive) const {
  if (!flow_->has_obstacles || snapshot.momentum == nullptr) return drive.on_solids.x();
  const MomentumBudget& momentum = *snapshot.momentum;
  return above_bed(momentum.on_solids) +
         (layers_.obstacles_are_the_bed(snapshot) ? 0.0 : above_bed(momentum.on_obstacles));
}

// Along x, of the half planes of cells above the bed.
double BedSurface::above_bed(const std::vector<Vec3>& by_height) const {
  double taken = 0.0;
  for (std::size_t h = 0; h < by_height.size(); ++h)
    if (static_cast<double>(h) * box_.size.z() > bed_height_ * static_cast<double>(by_height.size() - 1))
      taken += by_height[h].x();
  return taken;
}

void BedSurface::measure(const Snapshot& snapshot) {
  const BedLayers::Bed bed = layers_.bed(snapshot);
  bulk_ = bed.solid_fraction;
  bed_height_ = bed.height;
  if (!flow_ || flow_->shields_stress <= 0.0) return;
  if (lacks_momentum(snapshot)) return;  // the stress is that of the checkpoint
  bed_stress_ = ramp_at(snapshot.time, flow_->ramp) * flow_->driving_stress * hydraulic_radius();
  if (!flow_->measured || snapshot.fluid == nullptr) return;
  const FluidSource::Drive drive = snapshot.fluid->drive();
  const double plan = box_.size.x() * box_.size.y(), width = layers_.width();
  const double taken = drive.on_top.x() + taken_by_obstacles(snapshot, drive);
  const double left = drive.body_force.x() * (flow_depth() - bed.obstacles_above / plan) - taken / plan;
  bed_stress_ = left * width / (width + flow_->side_walls * flow_depth());
}

double BedSurface::flow_depth() const { return box_.size.z() - bed_height_; }

double BedSurface::hydraulic_radius() const {
  return thalweg::hydraulic_radius(flow_depth(), layers_.width(), flow_->side_walls);
}

std::vector<Diagnostic> BedSurface::diagnostics() const {
  std::vector<Diagnostic> diagnostics{{"bed_height", "m", bed_height_},
                                      {static_height, "m", mean_height(pixels_.surface())}};
  if (!flow_) return diagnostics;
  diagnostics.push_back({"flow_depth", "m", flow_depth()});
  diagnostics.push_back({"hydraulic_radius", "m", hydraulic_radius()});
  if (flow_->shields_stress <= 0.0) return diagnostics;
  diagnostics.push_back({"bed_stress", "Pa", bed_stress_});
  diagnostics.push_back({"shields_number", "1", bed_stress_ / flow_->shields_stress});
  return diagnostics;
}

std::vector<Diagnostic> BedSurface::results() const {
  // Means of nothing are not a number.
  const auto count = static_cast<double>(measurements_), stresses = static_cast<double>(stresses_);
  std::vector<Diagnostic> results;
  std::size_t n = 0;
  for (const Diagnostic& diagnostic : diagnostics())
    if (diagnostic.name != static_height)
      results.push_back(
          {diagnostic.name + "_mean", diagnostic.unit, sums_[n++] / (is_stress(diagnostic) ? stresses : count)});
  results.push_back({"bulk_solid_fraction_mean", "1", sums_[n] / count});
  const double pictures = static_cast<double>(pictures_);
  results.push_back({static_height + "_mean", "m", mean_height(means_of(surface_sums_, surface_counts_))});
  results.push_back({"static_share_mean", "1",
                     std::accumulate(surface_counts_.begin(), surface_counts_.end(), 0.0) /
                         (pictures * static_cast<double>(surface_counts_.size()))});
  results.push_back({"mean_from", "s", keys_.from});
  results.push_back({"measurements", "1", static_cast<double>(measurements_)});
  results.push_back({"static_pictures", "1", pictures});
  return results;
}

std::vector<Profile> BedSurface::profiles() const {
  const std::vector<std::uint64_t> shape{surface_sums_.size()};
  Profile x{"x", "m", {"x"}, {}, shape, {}}, mean{"static_surface", "m", {"x"}, {}, shape, {}};
  Profile latest{"latest_static_surface", "m", {"x"}, {}, shape, pixels_.surface()};
  latest.values.resize(surface_sums_.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t c = 0; c < surface_sums_.size(); ++c) {
    x.values.push_back((static_cast<double>(c) + 0.5) * pixels_.column_width());
    mean.values.push_back(surface_sums_[c] / surface_counts_[c]);
  }
  return {x, mean, latest};
}

SavedSettings BedSurface::settings() const {
  return {{"layer", keys_.layer.value_or(diameter_)},
          {"static_time", keys_.static_time},
          {"shields_stress", flow_ ? flow_->shields_stress : 0.0}};
}

void BedSurface::save(ArchiveWriter& archive) const {
  archive.attribute("bed_surface/mean_from", keys_.from);
  save_settings(archive, "bed_surface", settings());
  archive.attribute("bed_surface/seen_step", seen_step_);
  archive.attribute("bed_surface/measurements", measurements_);
  archive.attribute("bed_surface/stresses", stresses_);
  archive.attribute("bed_surface/pictures", pictures_);
  archive.attribute("bed_surface/latest_bed_height", bed_height_);  // a row of the series may come before the next
  archive.attribute("bed_surface/latest_bulk", bulk_);
  archive.attribute("bed_surface/latest_bed_stress", bed_stress_);
  write_whole(archive, communicator_, "bed_surface/sums", sums_);
  write_whole(archive, communicator_, "bed_surface/surface_sums", surface_sums_);
  write_whole(archive, communicator_, "bed_surface/surface_counts", surface_counts_);
  pixels_.save(archive, "bed_surface");
}

bool BedSurface::load(ArchiveReader& archive) {
  if (!has_all_or_none(archive, {"bed_surface/mean_from", "bed_surface/sums"}) ||
      !archive.has("bed_surface/surface_counts"))  // older checkpoints have none
    return false;
  auto sums = read_whole_if_alike<double>(archive, "bed_surface/sums", {sums_.size()});
  auto counts = read_whole_if_alike<double>(archive, "bed_surface/surface_counts", {surface_counts_.size()});
  if (!sums || !counts || archive.real_attribute("bed_surface/mean_from") != keys_.from ||
      !were_saved_with(archive, "bed_surface", settings()))
    return false;
  seen_step_ = archive.integer_attribute("bed_surface/seen_step");
  measurements_ = archive.integer_attribute("bed_surface/measurements");
  stresses_ = archive.has("bed_surface/stresses") ? archive.integer_attribute("bed_surface/stresses")
                                                  : measurements_;  // older checkpoints have none
  pictures_ = archive.integer_attribute("bed_surface/pictures");
  bed_height_ = archive.real_attribute("bed_surface/latest_bed_height");
  bulk_ = archive.real_attribute("bed_surface/latest_bulk");
  if (archive.has("bed_surface/latest_bed_stress"))  // older checkpoints have none
    bed_stress_ = archive.real_attribute("bed_surface/latest_bed_stress");
  sums_ = std::move(*sums);
  surface_counts_ = std::move(*counts);
  surface_sums_ = read_whole<double>(archive, "bed_surface/surface_sums", {surface_counts_.size()});
  if (pixels_.load(archive, "bed_surface") && pictures_ > 0 && pixels_.surface().empty())
    throw damaged_dataset("bed_surface/surface", fmt::format("the file has no such data, but {} pictures", pictures_));
  return true;
}

void describe(SectionVisitor& visit, BedSurfaceKeys& keys) {
  describe_from(visit, keys.from);
  describe_every(visit, keys.every);
  visit.real("layer", keys.layer,
             {.unit = "m",
              .meaning = "height over which the solid fraction is averaged; default: the reference diameter",
              .above = 0.0,
              .example = 5e-3});
  visit.real("pixel", keys.pixel,
             {.unit = "m",
              .meaning = "side of a pixel of the side view; default: 1/25 of the reference diameter",
              .above = 0.0,
              .example = 2e-4});
  visit.real("static_time", keys.static_time,
             {.unit = "s", .meaning = "a pixel is static after one grain has covered it for this long", .above = 0.0});
}

void check(const BedSurfaceKeys& keys, const RunContext& run) {
  require_grains(run, "measure");
  if (run.box.periodic[2])
    throw KeyError("",
                   "the bed height is measured from the bottom, but z is periodic; remove the section or give "
                   "domain.boundaries a bottom and a top, for example no_slip and free_slip");
  constexpr double thickest = 5.0;  // grains; an average over more has no surface
  const double grain = std::max(run.grains->reference_diameter, run.grains->largest_diameter);
  if (keys.layer && *keys.layer > thickest * grain * (1.0 + 1e-9))
    throw KeyError("layer", fmt::format("the solid fraction is averaged over about a grain, which is up to {:g} m "
                                        "wide; give at most {:.6g} m, or leave the key out",
                                        grain, thickest * grain));
  require_fine_pixel(run, keys.pixel);
}

std::optional<BedFlow> bed_flow(const RunContext& run) {
  if (!run.fluid) return std::nullopt;
  BedFlow flow;
  flow.side_walls = run.fluid->side_walls;
  if (run.fluid->side_walls_move) return flow;
  const bool by_slope = run.gravity.x() != 0.0 && run.gravity.z() < 0.0 && run.box.periodic[0] && !run.fluid->steered;
  if (!by_slope && !run.fluid->steered && !run.fluid->top_moves) return flow;
  flow.shields_stress =
      (run.grains->reference_density - run.fluid->density) * run.gravity.norm() * run.grains->reference_diameter;
  flow.driving_stress = run.fluid->density * run.gravity.x();
  const GrainContext& grains = *run.grains;
  const std::size_t spheres = grains.obstacles.spheres.size();
  const bool are_the_bed = grains.supplied.empty() && static_cast<GlobalId>(spheres) == grains.count();
  flow.has_obstacles = run.fluid->has_solids || (spheres > 0 && !are_the_bed);
  flow.ramp = run.ramp;
  flow.measured = run.fluid->steered || run.fluid->top_drags || run.fluid->has_solids || spheres > 0;
  return flow;
}

std::unique_ptr<Observer> make_observer(const BedSurfaceKeys& keys, const RunContext& run,
                                        const RunningSystem& system) {
  return std::make_unique<BedSurface>(system.communicator, run.box, keys, run.grains->reference_diameter, bed_flow(run),
                                      run.grains->disk_thickness, run.grains->obstacles);
}

ObserverMemory memory_of(const BedSurfaceKeys& keys, const RunContext& run, const RunSize& size) {
  const StaticPixels pixels = pixels_of(MPI_COMM_SELF, run.box, keys, run.grains->reference_diameter);
  return {.of_ids = size.ids * pixels.bytes_per_id(run.grains->largest_diameter),
          .while_saved = size.ids * pixels.saved_bytes_per_id(run.grains->largest_diameter)};
}

}  // namespace thalweg::analysis
