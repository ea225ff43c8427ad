#include "analysis/sizes/fractional_transport.hpp"

#include "analysis/tools/sphere_in_layer.hpp"
#include "core/state/whole_dataset.hpp"
#include "core/sums/reproducible_sum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>

namespace thalweg::analysis {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// Pixels of the plan across the finest free grain, but no more than so many across the reference grain.
constexpr double pixels_across_finest = 10.0, most_across_reference = 50.0;

constexpr std::size_t most_classes = 20;

// Diameter (m) of the sphere, or the disk, of a volume.
double diameter_of_volume(double volume, double disk_thickness) {
  return disk_thickness > 0.0 ? std::sqrt(4.0 * volume / (std::numbers::pi * disk_thickness))
                              : std::cbrt(6.0 * volume / std::numbers::pi);
}

double share_of(double part, double whole) { return whole > 0.0 ? part / whole : not_a_number; }

// Not a number where no free grain was seen at the surface.
double mean_of(const CorrelatedMean& mean) { return mean.count() > 0 ? mean.mean() : not_a_number; }

double sum_of(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

}  // namespace

FractionalTransport::FractionalTransport(MPI_Comm communicator, const PeriodicBox& box, const TransportScales& scales,
                                         const SizeClasses& classes, const FractionalTransportKeys& keys, double pixel,
                                         double disk_thickness)
    : MeanObserver(communicator, FractionalTransportKeys::section, keys.from, keys.every),
      scales_(scales),
      classes_(classes),
      moving_speed_(keys.moving_speed.value_or(scales.moving_speed())),
      area_(box.size.x() * (disk_thickness > 0.0 ? disk_thickness : box.size.y())),
      disk_thickness_(disk_thickness),
      view_(communicator, box, pixel, disk_thickness > 0.0),
      bed_volume_(static_cast<std::size_t>(classes.bins()), 0.0),
      bed_mass_(bed_volume_),
      bed_diameter_(bed_volume_),
      volume_sums_(bed_volume_),
      mass_sums_(bed_volume_),
      size_sums_(bed_volume_),
      load_sums_(bed_volume_),
      q_s_(classes.count(), 0.0),
      surface_share_(q_s_),
      moving_grains_(q_s_),
      load_(bed_volume_),
      means_(classes.count()) {}

bool FractionalTransport::measure(const Snapshot& snapshot, bool /*counts*/) {
  std::vector<SeenSphere> seen;
  measure_transport(sort_grains(snapshot.grains, seen));
  measure_surface(seen);
  return true;
}

// The free grains, and all spheres as they are seen: of two kinds for each bin, at rest and moving.
std::vector<FractionalTransport::Grain> FractionalTransport::sort_grains(const GrainView& grains,
                                                                         std::vector<SeenSphere>& seen) const {
  std::vector<Grain> sorted;
  const auto kind_of = [&](bool held, double diameter, double volume, double mass, const Vec3& velocity) {
    if (held) return -1;
    const bool moves = velocity.squaredNorm() > moving_speed_ * moving_speed_;
    const int bin = classes_.bin_of(diameter);
    sorted.push_back({bin, volume, mass, velocity.x(), moves});
    return 2 * bin + (moves ? 1 : 0);
  };
  std::map<GlobalId, int> kind_of_clump;
  for (const ClumpState& clump : grains.clumps)
    kind_of_clump[clump.id] = kind_of(clump.velocity_is_held, diameter_of_volume(clump.volume, disk_thickness_),
                                      clump.volume, clump.mass, clump.velocity);
  for (std::size_t i = 0; i < grains.id.size(); ++i) {
    const double radius = grains.radius[i];
    const int kind = grains.is_member(i)
                         ? kind_of_clump.at(grains.clump[i])
                         : kind_of(grains.velocity_is_held(i), 2.0 * radius, volume_of(radius, disk_thickness_),
                                   grains.mass[i], grains.velocity[i]);
    const Vec3& centre = grains.position[i];
    seen.push_back({grains.id[i], centre.x(), centre.y(), centre.z(), radius, kind});
  }
  return sorted;
}

void FractionalTransport::measure_transport(const std::vector<Grain>& grains) {
  const std::vector<double> sums =
      reproducible_sums_by_bin(communicator(), classes_.bins(), 5, [&](const TermTaker& take) {
        for (const Grain& grain : grains) {
          const double size = std::log(diameter_of_volume(grain.volume, disk_thickness_));
          const double row[] = {grain.volume, grain.volume * size, grain.mass, grain.volume * grain.v_x,
                                grain.moves ? 1.0 : 0.0};
          take(grain.bin, row);
        }
      });
  std::vector<double> moving(load_.size());
  for (std::size_t b = 0; b < load_.size(); ++b) {
    const double* sum = sums.data() + 5 * b;
    bed_volume_[b] = sum[0];
    bed_diameter_[b] = sum[0] > 0.0 ? std::exp(sum[1] / sum[0]) : 0.0;
    bed_mass_[b] = sum[2];
    load_[b] = sum[3] / area_;
    moving[b] = sum[4];
  }
  q_s_ = classes_.by_class(load_);
  moving_grains_ = classes_.by_class(moving);
}

void FractionalTransport::measure_surface(const std::vector<SeenSphere>& seen) {
  const std::vector<std::int64_t> pixels = view_.pixels_of(seen, 2 * classes_.bins());
  const double all = std::max(1.0, static_cast<double>(std::accumulate(pixels.begin(), pixels.end(), std::int64_t{0})));
  std::vector<double> shares;
  double moving = 0.0;
  for (std::size_t kind = 0; kind < pixels.size(); kind += 2) {
    shares.push_back(static_cast<double>(pixels[kind] + pixels[kind + 1]) / all);
    moving += static_cast<double>(pixels[kind + 1]);
  }
  surface_share_ = classes_.by_class(shares);
  latest_ = {median_diameter(shares, bed_diameter_), moving / all};
}

void FractionalTransport::add(const Snapshot& /*snapshot*/) {
  for (std::size_t c = 0; c < classes_.count(); ++c) {
    means_[c].q_s.add(q_s_[c]);
    means_[c].surface_share.add(surface_share_[c]);
    means_[c].moving_grains.add(moving_grains_[c]);
  }
  for (std::size_t b = 0; b < load_.size(); ++b) {
    volume_sums_[b] += bed_volume_[b];
    mass_sums_[b] += bed_mass_[b];
    if (bed_volume_[b] > 0.0) size_sums_[b] += bed_volume_[b] * std::log(bed_diameter_[b]);
    load_sums_[b] += load_[b];
  }
  if (std::isfinite(latest_[0])) surface_d50_.add(latest_[0]);
  if (const double ratio = latest_[0] / latest_bed_d50(); std::isfinite(ratio)) armouring_.add(ratio);
  moving_surface_sum_[0] += latest_[1];
}

double FractionalTransport::latest_bed_d50() const { return median_diameter(bed_volume_, bed_diameter_); }

// Mean diameters of the bins, m; 0 where there were no grains.
std::vector<double> FractionalTransport::mean_diameters() const {
  std::vector<double> diameters;
  for (std::size_t b = 0; b < volume_sums_.size(); ++b)
    diameters.push_back(volume_sums_[b] > 0.0 ? std::exp(size_sums_[b] / volume_sums_[b]) : 0.0);
  return diameters;
}

double FractionalTransport::bed_d50() const { return median_diameter(volume_sums_, mean_diameters()); }

// Along x or -x, whichever way more goes.
double FractionalTransport::load_d50() const {
  std::vector<double> downstream = load_sums_;
  if (sum_of(downstream) < 0.0)
    for (double& load : downstream) load = -load;
  const double d50 = median_diameter(downstream, mean_diameters());
  return d50 > 0.0 ? d50 : not_a_number;
}

struct FractionalTransport::Findings {
  std::vector<double> diameter, density, bed_share, surface_share, surface_share_error, load_share;
  std::vector<double> q_s, q_s_error, q_star, q_star_error, moving_grains, moving_grains_error;
};

FractionalTransport::Findings FractionalTransport::findings() const {
  Findings found;
  const std::vector<double> size = classes_.by_class(size_sums_);
  const std::vector<double> volume = classes_.by_class(volume_sums_), mass = classes_.by_class(mass_sums_);
  const double whole = sum_of(volume);
  double all = 0.0;
  for (const ClassMeans& means : means_) all += means.q_s.mean();
  for (std::size_t c = 0; c < classes_.count(); ++c) {
    const ClassMeans& means = means_[c];
    const double q_s = means.q_s.mean(), error = means.q_s.error().of_mean, share = means.surface_share.mean();
    found.diameter.push_back(volume[c] > 0.0 ? std::exp(size[c] / volume[c]) : classes_.middle(c));
    found.density.push_back(share_of(mass[c], volume[c]));
    found.bed_share.push_back(share_of(volume[c], whole));
    found.surface_share.push_back(share);
    found.surface_share_error.push_back(means.surface_share.error().of_mean);
    found.load_share.push_back(share_of(all < 0.0 ? -q_s : q_s, std::abs(all)));
    found.q_s.push_back(q_s);
    found.q_s_error.push_back(error);
    TransportScales scales = scales_;
    scales.grain_diameter = found.diameter[c];
    scales.grain_density = found.density[c];
    found.q_star.push_back(share_of(q_s, share * scales.flux()));
    found.q_star_error.push_back(share_of(error, share * scales.flux()));
    found.moving_grains.push_back(means.moving_grains.mean());
    found.moving_grains_error.push_back(means.moving_grains.error().of_mean);
  }
  return found;
}

std::vector<Diagnostic> FractionalTransport::diagnostics() const {
  std::vector<Diagnostic> diagnostics{{"surface_d50", "m", latest_[0]},
                                      {"armouring_ratio", "1", latest_[0] / latest_bed_d50()},
                                      {"moving_surface_share", "1", latest_[1]}};
  for (std::size_t c = 0; c < classes_.count(); ++c) {
    const std::string name = fmt::format("class_{}_", c);
    diagnostics.push_back({name + "q_s", "m^2/s", q_s_[c]});
    diagnostics.push_back({name + "surface_share", "1", surface_share_[c]});
    diagnostics.push_back({name + "moving_grains", "1", moving_grains_[c]});
  }
  return diagnostics;
}

std::vector<Diagnostic> FractionalTransport::results() const {
  const Findings found = findings();
  const CorrelatedMean::Error error = surface_d50_.error();
  std::vector<Diagnostic> results{
      {"bed_d50", "m", bed_d50()},
      {"surface_d50_mean", "m", mean_of(surface_d50_)},
      {"surface_d50_error", "m", error.of_mean},
      {"load_d50", "m", load_d50()},
      {"armouring_ratio_mean", "1", mean_of(armouring_)},
      {"armouring_ratio_error", "1", armouring_.error().of_mean},
      {"errors_hold", "1", error.holds() ? 1.0 : 0.0},
      {"moving_surface_share_mean", "1", moving_surface_sum_[0] / static_cast<double>(measurements())}};
  for (std::size_t c = 0; c < classes_.count(); ++c) {
    const auto add = [&, name = fmt::format("class_{}_", c)](const char* what, const char* unit, double value) {
      results.push_back({name + what, unit, value});
    };
    add("diameter", "m", found.diameter[c]);
    add("bed_share", "1", found.bed_share[c]);
    add("surface_share_mean", "1", found.surface_share[c]);
    add("surface_share_error", "1", found.surface_share_error[c]);
    add("load_share", "1", found.load_share[c]);
    add("q_s_mean", "m^2/s", found.q_s[c]);
    add("q_s_error", "m^2/s", found.q_s_error[c]);
    if (scales_.have_q_star()) {
      add("q_star_mean", "1", found.q_star[c]);
      add("q_star_error", "1", found.q_star_error[c]);
    }
    add("moving_grains_mean", "1", found.moving_grains[c]);
  }
  if (measurements() == 0) forget_values(results);
  add_count(results);
  for (const Diagnostic& latest : diagnostics()) results.push_back(latest);
  return results;
}

std::vector<std::string> FractionalTransport::remarks() const {
  if (measurements() == 0) return {};
  const double bed = bed_d50(), load = load_d50();
  if (!(bed > 0.0)) return {"sizes: there is no bed of free grains"};
  const std::string of_load = load > 0.0 ? fmt::format("{:.4g} m", load) : "unknown, as there is no net transport";
  if (surface_d50_.count() == 0)
    return {
        fmt::format("sizes: d50 of the bed {:.4g} m, of the load {}; no free grain is at its surface", bed, of_load)};
  return {fmt::format("sizes: d50 of the bed {:.4g} m, of its surface {} m, of the load {}; armouring ratio {}{}", bed,
                      with_error(surface_d50_, 1.0), of_load, with_error(armouring_, 1.0),
                      surface_d50_.error().holds() ? "" : "; too few measurements, the errors are larger")};
}

std::vector<Profile> FractionalTransport::profiles() const {
  const Findings found = findings();
  const std::uint64_t classes = classes_.count();
  std::vector<Profile> profiles{
      {"edges", "m", {"edges"}, {}, {classes + 1}, classes_.edges()},
      {"d50", "m", {}, {"bed", "surface", "load"}, {3}, {bed_d50(), mean_of(surface_d50_), load_d50()}}};
  const auto add = [&](const char* name, const char* unit, const std::vector<double>& values) {
    profiles.push_back({name, unit, {"diameter"}, {}, {classes}, values});
  };
  add("diameter", "m", found.diameter);
  add("density", "kg/m^3", found.density);
  add("bed_share", "1", found.bed_share);
  add("surface_share", "1", found.surface_share);
  add("surface_share_error", "1", found.surface_share_error);
  add("load_share", "1", found.load_share);
  add("q_s", "m^2/s", found.q_s);
  add("q_s_error", "m^2/s", found.q_s_error);
  if (scales_.have_q_star()) {
    add("q_star", "1", found.q_star);
    add("q_star_error", "1", found.q_star_error);
  }
  add("moving_grains", "1", found.moving_grains);
  add("moving_grains_error", "1", found.moving_grains_error);
  return profiles;
}

SavedSettings FractionalTransport::settings() const {
  SavedSettings settings{{"moving_speed", moving_speed_},
                         {"classes", static_cast<double>(classes_.count())},
                         {"pixels", static_cast<double>(view_.pixels())}};
  for (std::size_t e = 0; e < classes_.edges().size(); ++e)
    settings.push_back({fmt::format("edge_{}", e), classes_.edges()[e]});
  return settings;
}

void FractionalTransport::save_sums(ArchiveWriter& archive, const std::string& group) const {
  save_count(archive, group);
  std::vector<double> sums;
  for (const std::vector<double>* some : sums_of(*this)) sums.insert(sums.end(), some->begin(), some->end());
  write_whole(archive, communicator(), group + "/sums", sums);
  std::size_t n = 0;
  for (const CorrelatedMean* mean : means_of(*this))
    mean->save(archive, communicator(), fmt::format("{}/batches_{}", group, n++));
}

bool FractionalTransport::load_sums(ArchiveReader& archive, const std::string& group) {
  std::uint64_t size = 0;
  for (const std::vector<double>* some : sums_of(*this)) size += some->size();
  const auto sums = read_whole_if_alike<double>(archive, group + "/sums", {size});
  const std::size_t means = means_of(*this).size();
  if (!sums || !archive.has(fmt::format("{}/batches_{}", group, means - 1))) return false;
  load_count(archive, group);
  auto next = sums->begin();
  for (std::vector<double>* some : sums_of(*this)) {
    std::copy_n(next, some->size(), some->begin());
    next += static_cast<std::ptrdiff_t>(some->size());
  }
  std::size_t n = 0;
  for (CorrelatedMean* mean : means_of(*this)) mean->load(archive, fmt::format("{}/batches_{}", group, n++));
  return true;
}

static RealKey key_of_edges() {
  return {.unit = "m",
          .meaning =
              "of the size classes, in rising order, covering all free grains; default: the sieves of "
              "the case, a class for each of up to ten sizes, or classes of 1/2 phi",
          .above = 0.0,
          .examples = {2e-3, 4e-3, 8e-3}};
}

static void require_rising_edges(SectionVisitor& visit, const std::vector<double>& edges) {
  visit.require(edges.size() >= 2 && edges.size() <= most_classes + 1, "edges",
                fmt::format("give the edges of 1 to {} classes in m, one more than classes", most_classes));
  visit.require(std::is_sorted(edges.begin(), edges.end(), std::less_equal<>()), "edges", "the edges must rise");
}

void describe(SectionVisitor& visit, FractionalTransportKeys& keys) {
  describe_from(visit, keys.from);
  visit.real("every", keys.every,
             {.unit = "s", .meaning = "between measurements; 0: with the rows of series.csv", .at_least = 0.0});
  visit.real_list("edges", keys.edges, key_of_edges());
  describe_moving_speed(visit, keys.moving_speed);
  if (visit.reading() && !keys.edges.empty()) require_rising_edges(visit, keys.edges);
}

void check(const FractionalTransportKeys& keys, const RunContext& run) {
  require_grains(run, "measure");
  const GrainContext& grains = *run.grains;
  if (run.box.periodic[2])
    throw KeyError("",
                   "the surface of a bed is seen from above, but z is periodic; remove the section or give "
                   "domain.boundaries a bottom and a top, for example no_slip and free_slip");
  if (!grains.any_free()) throw KeyError("", "no grain is free to move, so there is no transport; remove the section");
  if (keys.edges.empty()) return;
  constexpr double rounding = 1e-9;
  if (keys.edges.front() > (1.0 + rounding) * grains.smallest_free ||
      keys.edges.back() < (1.0 - rounding) * grains.largest_free)
    throw KeyError(
        "edges", fmt::format("the edges reach from {:g} to {:g} m but must cover all free grains, from {:g} to {:g} m",
                             keys.edges.front(), keys.edges.back(), grains.smallest_free, grains.largest_free));
}

std::optional<std::string> warning(const FractionalTransportKeys&, const RunContext& run) {
  if (run.grains->smallest_free != run.grains->largest_free) return std::nullopt;
  return fmt::format(
      "All free grains have one size, {:g} m, so analysis.fractional_transport has one class: consider "
      "analysis.transport_rate alone.",
      run.grains->largest_free);
}

std::unique_ptr<Observer> make_observer(const FractionalTransportKeys& keys, const RunContext& run,
                                        const RunningSystem& system) {
  const GrainContext& grains = *run.grains;
  const double pixel =
      std::max(grains.smallest_free / pixels_across_finest, grains.reference_diameter / most_across_reference);
  const SizeClasses classes(keys.edges.empty() ? grains.size_class_edges : keys.edges);
  return std::make_unique<FractionalTransport>(system.communicator, run.box, transport_scales(run), classes, keys,
                                               pixel, grains.disk_thickness);
}

}  // namespace thalweg::analysis
