#include "analysis/bed_surface.hpp"

#include "analysis/bed_height.hpp"
#include "analysis/sphere_in_layer.hpp"
#include "core/mpi_session.hpp"
#include "core/order_free_sum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace thalweg::analysis {

namespace {

constexpr int thin_layers_a_layer = 10;
const std::string static_height = "static_bed_height";

double mean_of(const std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// For each clump, its volume over that of its members together, which may overlap.
std::map<GlobalId, double> shares_of_members(const GrainView& grains) {
  std::map<GlobalId, double> shares;
  for (std::size_t i = 0; i < grains.id.size(); ++i)
    if (grains.is_member(i)) shares[grains.clump[i]] += volume_of(grains.radius[i], grains.disk_thickness);
  for (const ClumpState& clump : grains.clumps) shares.at(clump.id) = clump.volume / shares.at(clump.id);
  return shares;
}

}  // namespace

BedSurface::BedSurface(MPI_Comm communicator, const PeriodicBox& box, const BedSurfaceSettings& settings,
                       const std::optional<BedFlow>& flow, double disk_thickness)
    : communicator_(communicator),
      box_(box),
      settings_(settings),
      flow_(flow),
      layers_(std::max(1, static_cast<int>(std::lround(thin_layers_a_layer * box.size.z() / settings.layer)))),
      thickness_(box.size.z() / layers_),
      width_(disk_thickness > 0.0 ? disk_thickness : box.size.y()),
      pixels_(communicator, box, settings.pixel, settings.static_time),
      surface_sums_(static_cast<std::size_t>(pixels_.columns()), 0.0) {
  sums_.assign(figures().size(), 0.0);
}

void BedSurface::observe(const Snapshot& snapshot) {
  // A run that goes on from a checkpoint looks once more at the state the checkpoint holds.
  const bool again = snapshot.step <= seen_step_;
  measure(snapshot);
  if (again) return;
  seen_step_ = snapshot.step;
  const double from = settings_.from * (1.0 - 1e-12);
  if (pixels_.look(snapshot) && pixels_.begun() >= from) {
    ++pictures_;
    for (std::size_t c = 0; c < surface_sums_.size(); ++c) surface_sums_[c] += pixels_.surface()[c];
  }
  if (snapshot.time < from) return;
  ++measurements_;
  std::size_t n = 0;
  for (const Figure& figure : figures())
    if (figure.name != static_height) sums_[n++] += figure.value;
  sums_[n] += bulk_;
}

std::vector<double> BedSurface::volume_below(const Snapshot& snapshot) const {
  const GrainView& grains = snapshot.grains;
  const std::map<GlobalId, double> shares = shares_of_members(grains);
  std::vector<int> layer_of_row;
  std::vector<double> volumes;
  for (std::size_t i = 0; i < grains.id.size(); ++i) {
    const double radius = grains.radius[i], foot = grains.position[i].z() - radius;
    const double share = grains.is_member(i) ? shares.at(grains.clump[i]) : 1.0;
    const int first = static_cast<int>(std::floor(foot / thickness_));
    const int last = static_cast<int>(std::floor((foot + 2.0 * radius) / thickness_));
    for (int layer = std::max(0, first); layer <= std::min(layers_ - 1, last); ++layer) {
      // What a wall overlaps belongs to the layer at the wall, so that no volume is lost.
      const double lower = layer == 0 ? 0.0 : layer * thickness_ - foot;
      const double upper = layer == layers_ - 1 ? 2.0 * radius : (layer + 1) * thickness_ - foot;
      layer_of_row.push_back(layer);
      volumes.push_back(share * volume_between(radius, grains.disk_thickness, lower, upper));
    }
  }
  const std::vector<double> in_layer = order_free_sums_by_bin(communicator_, layer_of_row, layers_, volumes, 1);
  std::vector<double> below{0.0};
  for (const double volume : in_layer) below.push_back(below.back() + volume);
  return below;
}

void BedSurface::measure(const Snapshot& snapshot) {
  const std::vector<double> volumes = volume_below(snapshot);
  const VolumeBelow below{volumes, thickness_, box_.size.x() * width_};
  bulk_ = bulk_solid_fraction(below);
  bed_height_ = bed_height(below, thin_layers_a_layer / 2);
}

std::vector<Figure> BedSurface::figures() const {
  std::vector<Figure> figures{{"bed_height", "m", bed_height_}, {static_height, "m", mean_of(pixels_.surface())}};
  if (!flow_) return figures;
  const double depth = box_.size.z() - bed_height_;
  const double radius = depth * width_ / (width_ + flow_->side_walls * depth);
  figures.push_back({"flow_depth", "m", depth});
  figures.push_back({"hydraulic_radius", "m", radius});
  if (flow_->driving_stress <= 0.0) return figures;
  figures.push_back({"bed_stress", "Pa", flow_->driving_stress * radius});
  figures.push_back({"shields_number", "1", flow_->driving_stress * radius / flow_->shields_stress});
  return figures;
}

std::vector<Figure> BedSurface::results() const {
  const double count = static_cast<double>(std::max<std::int64_t>(1, measurements_));
  std::vector<Figure> results;
  std::size_t n = 0;
  for (const Figure& figure : figures())
    if (figure.name != static_height) results.push_back({figure.name + "_mean", figure.unit, sums_[n++] / count});
  results.push_back({"bulk_solid_fraction_mean", "1", sums_[n] / count});
  const double pictures = static_cast<double>(pictures_);
  results.push_back({static_height + "_mean", "m", mean_of(surface_sums_) / pictures});  // not a number without any
  results.push_back({"mean_from", "s", settings_.from});
  results.push_back({"measurements", "1", static_cast<double>(measurements_)});
  results.push_back({"static_pictures", "1", pictures});
  return results;
}

std::vector<Profile> BedSurface::profiles() const {
  const std::vector<std::uint64_t> shape{surface_sums_.size()};
  Profile x{"x", "m", {}, shape, {}}, mean{"static_surface", "m", {}, shape, {}};
  Profile latest{"latest_static_surface", "m", {}, shape, pixels_.surface()};
  latest.values.resize(surface_sums_.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t c = 0; c < surface_sums_.size(); ++c) {
    x.values.push_back((static_cast<double>(c) + 0.5) * pixels_.column_width());
    mean.values.push_back(surface_sums_[c] / static_cast<double>(pictures_));
  }
  return {x, mean, latest};
}

void BedSurface::save(ArchiveWriter& archive) const {
  archive.attribute("bed_surface/mean_from", settings_.from);
  archive.attribute("bed_surface/seen_step", seen_step_);
  archive.attribute("bed_surface/measurements", measurements_);
  archive.attribute("bed_surface/pictures", pictures_);
  archive.attribute("bed_surface/latest_bed_height", bed_height_);  // a row of the series may come before the next
  archive.attribute("bed_surface/latest_bulk", bulk_);
  const bool first = rank_of(communicator_) == 0;
  const auto write = [&](const std::string& path, const std::vector<double>& values) {
    const std::uint64_t size = values.size(), mine = first ? size : 0;
    archive.write(path, std::span<const double>(values).first(mine), {{size}, {0}, {mine}});
  };
  write("bed_surface/sums", sums_);
  write("bed_surface/surface_sums", surface_sums_);
  pixels_.save(archive, "bed_surface");
}

void BedSurface::load(ArchiveReader& archive) {
  if (!archive.has("bed_surface/mean_from") || archive.real_attribute("bed_surface/mean_from") != settings_.from ||
      archive.shape("bed_surface/sums") != std::vector<std::uint64_t>{sums_.size()} ||
      archive.shape("bed_surface/surface_sums") != std::vector<std::uint64_t>{surface_sums_.size()})
    return;
  seen_step_ = archive.integer_attribute("bed_surface/seen_step");
  measurements_ = archive.integer_attribute("bed_surface/measurements");
  pictures_ = archive.integer_attribute("bed_surface/pictures");
  bed_height_ = archive.real_attribute("bed_surface/latest_bed_height");
  bulk_ = archive.real_attribute("bed_surface/latest_bulk");
  const auto read = [&](const std::string& path, std::vector<double>& values) {
    archive.read(path, std::span<double>(values), {{values.size()}, {0}, {values.size()}});
  };
  read("bed_surface/sums", sums_);
  read("bed_surface/surface_sums", surface_sums_);
  pixels_.load(archive, "bed_surface");
}

}  // namespace thalweg::analysis
