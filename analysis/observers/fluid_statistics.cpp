#include "analysis/observers/fluid_statistics.hpp"

#include "analysis/tools/tensor_names.hpp"
#include "core/geometry/symmetric_pairs.hpp"
#include "core/state/whole_dataset.hpp"
#include "core/sums/fixed_point.hpp"
#include "core/sums/wide_sums_over_ranks.hpp"

#include <algorithm>

namespace thalweg::analysis {

namespace {

constexpr int fraction_bits = 40;
using VelocitySum = FixedPoint<fraction_bits>;

}  // namespace

FluidStatistics::FluidStatistics(MPI_Comm communicator, const Decomposition& decomposition, double velocity_unit,
                                 const FluidStatisticsKeys& keys, bool sections)
    : MeanObserver(communicator, FluidStatisticsKeys::section, keys.from, keys.every),
      cells_(decomposition.cells()),
      spacing_(decomposition.spacing()),
      velocity_unit_(velocity_unit),
      sections_(sections),
      sums_(static_cast<std::size_t>(bins()) * quantities) {}

bool FluidStatistics::measure(const Snapshot& snapshot, bool /*counts*/) { return snapshot.fluid != nullptr; }

void FluidStatistics::add(const Snapshot& snapshot) {
  std::vector<WideSum> sums(sums_.size());
  snapshot.fluid->for_each_velocity([&](const Index3& cell, const Vec3& velocity_si) {
    const int bin = sections_ ? cell[2] * cells_[1] + cell[1] : cell[2];
    WideSum* columns = sums.data() + static_cast<std::size_t>(bin) * quantities;
    const Vec3 u = velocity_si / velocity_unit_;
    columns[count].add(1);
    for (int a = 0; a < 3; ++a) columns[velocity + a].add(VelocitySum::from(u[a]));
    for (int p = 0; p < 6; ++p)
      columns[product + p].add(VelocitySum::from(u[symmetric_pairs[p][0]] * u[symmetric_pairs[p][1]]));
  });
  sum_over_ranks(communicator(), sums);
  for (std::size_t s = 0; s < sums.size(); ++s) sums_[s].add(sums[s]);
}

std::vector<WideSum> FluidStatistics::layer(int z) const {
  const int lines = sections_ ? cells_[1] : 1;
  std::vector<WideSum> sums(quantities);
  for (int line = 0; line < lines; ++line)
    for (int q = 0; q < quantities; ++q)
      sums[q].add(sums_[(static_cast<std::size_t>(z) * lines + line) * quantities + q]);
  return sums;
}

FluidStatistics::Means FluidStatistics::means_of(const WideSum* sums, double cells) const {
  Means means;
  const double n = sums[count].to_double(0);
  if (n == 0.0) return means;
  means.fluid_fraction = n / (cells * static_cast<double>(measurements()));
  double u[3];
  for (int a = 0; a < 3; ++a) {
    u[a] = sums[velocity + a].to_double(fraction_bits) / n;
    means.velocity[a] = u[a] * velocity_unit_;
  }
  for (int p = 0; p < 6; ++p)
    means.stress[p] =
        (sums[product + p].to_double(fraction_bits) / n - u[symmetric_pairs[p][0]] * u[symmetric_pairs[p][1]]) *
        velocity_unit_ * velocity_unit_;
  return means;
}

std::vector<Diagnostic> FluidStatistics::results() const {
  std::vector<WideSum> all(quantities);
  for (int z = 0; z < cells_[2]; ++z) {
    const std::vector<WideSum> sums = layer(z);
    for (int q = 0; q < quantities; ++q) all[q].add(sums[q]);
  }
  std::vector<Diagnostic> results{{"mean_velocity_x", "m/s", means_of(all.data(), 1.0).velocity[0]}};
  if (measurements() == 0) forget_values(results);
  add_count(results);
  return results;
}

std::vector<Profile> FluidStatistics::profiles() const {
  const auto nx = static_cast<double>(cells_[0]), ny = static_cast<double>(cells_[1]);
  const auto heights = static_cast<std::uint64_t>(cells_[2]), widths = static_cast<std::uint64_t>(cells_[1]);
  const auto centres = [&](const std::string& axis, int n) {
    Profile profile{axis, "m", {axis}, {}, {static_cast<std::uint64_t>(n)}, {}};
    for (int k = 0; k < n; ++k) profile.values.push_back((k + 0.5) * spacing_);
    return profile;
  };
  const auto add = [](std::vector<Profile>& to, const Means& means) {
    to[0].values.insert(to[0].values.end(), means.velocity, means.velocity + 3);
    to[1].values.insert(to[1].values.end(), means.stress, means.stress + 6);
    to[2].values.push_back(means.fluid_fraction);
  };
  const auto empty = [](const std::string& prefix, std::vector<std::string> axes, std::vector<std::uint64_t> shape) {
    std::vector<Profile> profiles{{prefix + "velocity", "m/s", axes, vector_names, shape, {}},
                                  {prefix + "reynolds_stress", "m^2/s^2", axes, symmetric_names, shape, {}},
                                  {prefix + "fluid_fraction", "1", axes, {}, shape, {}}};
    profiles[0].shape.push_back(3);
    profiles[1].shape.push_back(6);
    return profiles;
  };
  std::vector<Profile> layers = empty("", {"z"}, {heights});
  for (int z = 0; z < cells_[2]; ++z) add(layers, means_of(layer(z).data(), nx * ny));
  std::vector<Profile> all{centres("z", cells_[2])};
  all.insert(all.end(), layers.begin(), layers.end());
  if (!sections_) return all;
  all.push_back(centres("y", cells_[1]));
  std::vector<Profile> lines = empty("section_", {"z", "y"}, {heights, widths});
  for (int bin = 0; bin < bins(); ++bin)
    add(lines, means_of(sums_.data() + static_cast<std::size_t>(bin) * quantities, nx));
  all.insert(all.end(), lines.begin(), lines.end());
  return all;
}

void FluidStatistics::save_sums(ArchiveWriter& archive, const std::string& group) const {
  save_count(archive, group);
  std::vector<std::int64_t> values;
  for (const WideSum& sum : sums_) values.insert(values.end(), {sum.high, sum.low});
  write_whole(archive, communicator(), group + "/sums", std::span<const std::int64_t>(values), shape());
}

bool FluidStatistics::load_sums(ArchiveReader& archive, const std::string& group) {
  const auto values = read_whole_if_alike<std::int64_t>(archive, group + "/sums", shape());
  if (!values) return false;
  load_count(archive, group);
  for (std::size_t s = 0; s < sums_.size(); ++s) sums_[s] = {(*values)[2 * s], (*values)[2 * s + 1]};
  return true;
}

void describe(SectionVisitor& visit, FluidStatisticsKeys& keys) {
  describe_from(visit, keys.from);
  describe_every(visit, keys.every);
}

std::unique_ptr<Observer> make_observer(const FluidStatisticsKeys& keys, const RunContext& run,
                                        const RunningSystem& system) {
  return std::make_unique<FluidStatistics>(system.communicator, system.decomposition, run.fluid->velocity_unit, keys,
                                           !run.box.periodic[1]);
}

}  // namespace thalweg::analysis
