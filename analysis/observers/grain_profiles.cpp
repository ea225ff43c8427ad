#include "analysis/observers/grain_profiles.hpp"

#include "analysis/tools/sphere_in_layer.hpp"
#include "analysis/tools/tensor_names.hpp"
#include "core/geometry/symmetric_pairs.hpp"
#include "core/state/contact_stress.hpp"
#include "core/state/whole_dataset.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace thalweg::analysis {

// A grain as the sums take it. The members of a clump share its volume, mass and contact moment as their own volumes
// are to each other, and move with its centre, so that its parts add up to the clump.
struct WeightedBody {
  double spheres = 0.0;             // m^3, of all spheres that share what follows: one, or the members
  double volume = 0.0, mass = 0.0;  // m^3, kg
  Vec3 velocity = Vec3::Zero();     // m/s
  Mat3 moment = Mat3::Zero();       // N m, sum over contacts of F_a r_b, rows a, columns b
  // Of a clump: unit vectors along the principal axes of the least and of the largest moment of inertia.
  Vec3 long_axis = Vec3::Zero(), short_axis = Vec3::Zero();
};

namespace {

// A principal axis in space.
Vec3 axis_of(const ClumpState& clump, Eigen::Index number) {
  const auto& [w, x, y, z] = clump.orientation;
  return Eigen::Quaterniond(w, x, y, z).toRotationMatrix().col(number);
}

class WeightedBodies {
public:
  // The arms r of the snapshot are from the centre of the grain or of the clump.
  explicit WeightedBodies(const Snapshot& snapshot) : grains_(snapshot.grains), moments_(contact_moments(snapshot)) {
    for (std::size_t i = 0; i < moments_.size(); ++i)
      if (grains_.is_member(i)) {
        WeightedBody& clump = clumps_[grains_.clump[i]];
        clump.spheres += volume_of(grains_.radius[i], grains_.disk_thickness);
        clump.moment += moments_[i];
      }
    for (const ClumpState& state : grains_.clumps) {  // owned here, and so are their members
      WeightedBody& clump = clumps_.at(state.id);
      clump.volume = state.volume;
      clump.mass = state.mass;
      clump.velocity = state.velocity;
      Eigen::Index least = 0, largest = 0;
      state.moments.minCoeff(&least);
      state.moments.maxCoeff(&largest);
      clump.long_axis = axis_of(state, least);
      clump.short_axis = axis_of(state, largest);
    }
  }

  WeightedBody operator[](std::size_t i) const {
    if (grains_.is_member(i)) return clumps_.at(grains_.clump[i]);
    const double volume = volume_of(grains_.radius[i], grains_.disk_thickness);
    return {volume, volume, grains_.mass[i], grains_.velocity[i], moments_[i]};
  }

private:
  const GrainView& grains_;
  std::vector<Mat3> moments_;
  std::map<GlobalId, WeightedBody> clumps_;
};

}  // namespace

GrainProfiles::GrainProfiles(MPI_Comm communicator, const Decomposition& decomposition, double layer,
                             const GrainProfilesKeys& keys, double disk_thickness, bool clumps)
    : MeanObserver(communicator, GrainProfilesKeys::section, keys.from, keys.every),
      box_(decomposition.box()),
      width_(disk_thickness > 0.0 ? disk_thickness : box_.size[1]),
      layers_(std::max(1, static_cast<int>(std::lround(box_.size[2] / keys.layer.value_or(layer))))),
      thickness_(box_.size[2] / layers_),
      sums_(static_cast<std::size_t>(layers_) * quantities, 0.0),
      axes_(clumps ? static_cast<std::size_t>(layers_) * axes_quantities : 0, 0.0) {}

void GrainProfiles::add(const Snapshot& snapshot) {
  const WeightedBodies bodies(snapshot);
  const GrainView& grains = snapshot.grains;
  const std::vector<double> sums =
      reproducible_sums_by_bin(communicator(), layers_, quantities, [&](const TermTaker& take) {
        for (std::size_t i = 0; i < grains.id.size(); ++i) give_parts(grains, i, bodies[i], take);
      });
  for (std::size_t s = 0; s < sums.size(); ++s) sums_[s] += sums[s];
  if (axes_.empty()) return;
  const std::vector<double> axes =
      reproducible_sums_by_bin(communicator(), layers_, axes_quantities, [&](const TermTaker& take) {
        for (std::size_t i = 0; i < grains.id.size(); ++i)
          if (grains.is_member(i)) give_axes(grains, i, bodies[i], take);
      });
  for (std::size_t s = 0; s < axes.size(); ++s) axes_[s] += axes[s];
}

template <typename Visit>
void GrainProfiles::for_each_layer(const GrainView& grains, std::size_t i, const Visit& visit) const {
  const double radius = grains.radius[i], bottom = grains.position[i][2] - radius;
  const int first = static_cast<int>(std::floor(bottom / thickness_));
  const int last = static_cast<int>(std::floor((bottom + 2.0 * radius) / thickness_));
  for (int layer = first; layer <= last; ++layer) {
    const int inside = box_.periodic[2] ? (layer % layers_ + layers_) % layers_ : layer;
    if (inside < 0 || inside >= layers_) continue;
    visit(inside, volume_between(radius, grains.disk_thickness, layer * thickness_ - bottom,
                                 (layer + 1) * thickness_ - bottom));
  }
}

// The quantities of the part of grain i in each layer.
void GrainProfiles::give_parts(const GrainView& grains, std::size_t i, const WeightedBody& body,
                               const TermTaker& take) const {
  const Vec3& v = body.velocity;
  for_each_layer(grains, i, [&](int layer, double part) {
    const double share = part / body.spheres, m = share * body.mass;
    const double inside_it = grains.is_member(i) ? share * body.volume : part;
    std::array<double, quantities> row{inside_it, m, m * v[0], m * v[1], m * v[2]};
    for (std::size_t p = 0; p < 6; ++p) row[product + p] = m * v[symmetric_pairs[p][0]] * v[symmetric_pairs[p][1]];
    for (int a = 0; a < 3; ++a) row[flux + a] = inside_it * v[a];
    for (int k = 0; k < 9; ++k) row[contact + k] = share * body.moment(k / 3, k % 3);
    take(layer, row);
  });
}

void GrainProfiles::give_axes(const GrainView& grains, std::size_t i, const WeightedBody& body,
                              const TermTaker& take) const {
  for_each_layer(grains, i, [&](int layer, double part) {
    const double inside_it = part / body.spheres * body.volume;
    std::array<double, axes_quantities> row{inside_it};
    for (std::size_t p = 0; p < 6; ++p) {
      const auto& [a, b] = symmetric_pairs[p];
      row[long_axis + p] = inside_it * body.long_axis[a] * body.long_axis[b];
      row[short_axis + p] = inside_it * body.short_axis[a] * body.short_axis[b];
    }
    take(layer, row);
  });
}

std::vector<Diagnostic> GrainProfiles::results() const {
  std::vector<Diagnostic> results;
  add_count(results);
  return results;
}

std::vector<Profile> GrainProfiles::profiles() const {
  const auto n = static_cast<std::uint64_t>(layers_);
  Profile z{"z", "m", {"z"}, {}, {n}, {}}, fraction{"solid_fraction", "1", {"z"}, {}, {n}, {}};
  Profile velocity{"velocity", "m/s", {"z"}, vector_names, {n, 3}, {}},
      volume_flux{"flux", "m/s", {"z"}, vector_names, {n, 3}, {}};
  Profile temperature{"granular_temperature", "m^2/s^2", {"z"}, {}, {n}, {}};
  Profile contact_stress{"contact_stress", "Pa", {"z"}, tensor_names, {n, 9}, {}};
  Profile kinetic_stress{"kinetic_stress", "Pa", {"z"}, symmetric_names, {n, 6}, {}};
  // Volume of a layer times the number of measurements.
  const double room =
      box_.size[0] * width_ * thickness_ * static_cast<double>(std::max<std::int64_t>(1, measurements()));
  for (int layer = 0; layer < layers_; ++layer) {
    const double* sum = sums_.data() + static_cast<std::size_t>(layer) * quantities;
    z.values.push_back((layer + 0.5) * thickness_);
    fraction.values.push_back(sum[volume] / room);
    Vec3 u = Vec3::Zero();
    double square = 0.0;
    if (sum[mass] > 0.0) {
      u = Vec3(sum + momentum) / sum[mass];
      square = (sum[product] + sum[product + 1] + sum[product + 2]) / sum[mass];
    }
    temperature.values.push_back(std::max(0.0, (square - u.squaredNorm()) / 3.0));
    for (int a = 0; a < 3; ++a) velocity.values.push_back(u[a]);
    for (int a = 0; a < 3; ++a) volume_flux.values.push_back(sum[flux + a] / room);
    for (int c = 0; c < 9; ++c) contact_stress.values.push_back(sum[contact + c] / room);
    for (int p = 0; p < 6; ++p)
      kinetic_stress.values.push_back(
          -(sum[product + p] - sum[mass] * u[symmetric_pairs[p][0]] * u[symmetric_pairs[p][1]]) / room);
  }
  std::vector<Profile> all{z, fraction, velocity, volume_flux, temperature, contact_stress, kinetic_stress};
  if (!axes_.empty())
    for (Profile& profile : axes_profiles()) all.push_back(std::move(profile));
  return all;
}

std::vector<Profile> GrainProfiles::axes_profiles() const {
  const auto n = static_cast<std::uint64_t>(layers_);
  Profile fraction{"clump_fraction", "1", {"z"}, {}, {n}, {}};
  Profile long_ones{"long_axis_alignment", "1", {"z"}, symmetric_names, {n, 6}, {}},
      short_ones{"short_axis_alignment", "1", {"z"}, symmetric_names, {n, 6}, {}};
  const double room =
      box_.size[0] * width_ * thickness_ * static_cast<double>(std::max<std::int64_t>(1, measurements()));
  for (int layer = 0; layer < layers_; ++layer) {
    const double* sum = axes_.data() + static_cast<std::size_t>(layer) * axes_quantities;
    const double whole = sum[clump_volume], unit = whole > 0.0 ? 1.0 / whole : 0.0;
    fraction.values.push_back(whole / room);
    for (int p = 0; p < 6; ++p) long_ones.values.push_back(unit * sum[long_axis + p]);
    for (int p = 0; p < 6; ++p) short_ones.values.push_back(unit * sum[short_axis + p]);
  }
  return {fraction, long_ones, short_ones};
}

void GrainProfiles::save_sums(ArchiveWriter& archive, const std::string& group) const {
  save_count(archive, group);
  write_whole(archive, communicator(), group + "/sums", std::span<const double>(sums_), shape());
  if (!axes_.empty())
    write_whole(archive, communicator(), group + "/axes", std::span<const double>(axes_), axes_shape());
}

bool GrainProfiles::load_sums(ArchiveReader& archive, const std::string& group) {
  auto sums = read_whole_if_alike<double>(archive, group + "/sums", shape());
  if (!sums || (!axes_.empty() && !archive.has(group + "/axes"))) return false;  // older checkpoints have no axes
  if (!axes_.empty()) axes_ = read_whole<double>(archive, group + "/axes", axes_shape());
  load_count(archive, group);
  sums_ = std::move(*sums);
  return true;
}

void describe(SectionVisitor& visit, GrainProfilesKeys& keys) {
  describe_from(visit, keys.from);
  describe_every(visit, keys.every);
  visit.real(
      "layer", keys.layer,
      {.unit = "m",
       .meaning = "height of a layer, adjusted to fill the box with whole layers; default: half the largest diameter",
       .above = 0.0,
       .example = 2.5e-3});
}

void check(const GrainProfilesKeys& keys, const RunContext& run) { require_layer_in_box(run, keys.layer); }

std::unique_ptr<Observer> make_observer(const GrainProfilesKeys& keys, const RunContext& run,
                                        const RunningSystem& system) {
  return std::make_unique<GrainProfiles>(system.communicator, system.decomposition, 0.5 * run.grains->largest_diameter,
                                         keys, run.grains->disk_thickness, run.grains->any_clumps());
}

}  // namespace thalweg::analysis
