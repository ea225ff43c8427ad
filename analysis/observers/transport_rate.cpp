#include "analysis/observers/transport_rate.hpp"

#include "core/parallel/mpi_session.hpp"
#include "core/state/whole_dataset.hpp"
#include "core/sums/reproducible_sum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace thalweg::analysis {

namespace {

// Range of velocities in fall speeds, in either direction: water over a bed of sand or gravel seldom carries a grain
// faster than ten.
constexpr double slowest = -15.0, fastest = 15.0;
constexpr int velocity_bins = 300;

}  // namespace

TransportRate::TransportRate(MPI_Comm communicator, const TransportScales& scales, const TransportRateKeys& keys,
                             bool recirculation)
    : MeanObserver(communicator, TransportRateKeys::section, keys.from, keys.every),
      scales_(scales),
      moving_speed_(keys.moving_speed.value_or(scales.moving_speed())),
      velocities_{Histogram::linear(slowest * scales.fall_speed(), fastest * scales.fall_speed(), velocity_bins),
                  Histogram::linear(slowest * scales.fall_speed(), fastest * scales.fall_speed(), velocity_bins),
                  Histogram::linear(slowest * scales.fall_speed(), fastest * scales.fall_speed(), velocity_bins)},
      hops_(communicator, scales.grain_diameter, scales.grain_diameter / scales.fall_speed(), moving_speed_,
            recirculation) {}

bool TransportRate::measure(const Snapshot& snapshot, bool counts) {
  const std::vector<Body> bodies = free_bodies_of(snapshot.grains);
  measure_bodies(snapshot, bodies);
  // A state seen twice, as at a restart, does not change the hops.
  hops_.observe(snapshot.time, snapshot.decomposition->box(), snapshot.grains.end_of_ids(), bodies, counts);
  return true;
}

void TransportRate::add(const Snapshot& snapshot) {
  if (q_s_.count() == 0) first_time_ = snapshot.time;
  last_time_ = snapshot.time;
  q_s_.add(latest_.q_s);
  moving_.add(static_cast<double>(latest_.moving));
  sum_of_shares_ += latest_.share();
  sum_of_activity_ += latest_.activity;
  count_velocities(free_bodies_of(snapshot.grains));
}

void TransportRate::measure_bodies(const Snapshot& snapshot, const std::vector<Body>& bodies) {
  std::vector<double> terms;
  std::int64_t moving = 0;
  double largest_squared = 0.0;
  for (const Body& body : bodies) {
    const double speed_squared = body.velocity.squaredNorm();
    const bool moves = speed_squared > moving_speed_ * moving_speed_;
    terms.insert(terms.end(), {body.volume * body.velocity.x(), moves ? body.volume : 0.0});
    if (moves) ++moving;
    largest_squared = std::max(largest_squared, speed_squared);
  }
  const Vec3 size = snapshot.decomposition->box().size;
  const double width = snapshot.grains.disk_thickness > 0.0 ? snapshot.grains.disk_thickness : size.y();
  const std::vector<double> sums = reproducible_sums(communicator(), terms, 2);
  latest_.q_s = sums[0] / (size.x() * width);
  latest_.activity = sums[1] / (size.x() * width);
  latest_.moving = sum_over_ranks(communicator(), moving);
  latest_.grains = sum_over_ranks(communicator(), static_cast<std::int64_t>(bodies.size()));
  latest_.largest_speed = std::sqrt(max_over_ranks(communicator(), largest_squared));
}

void TransportRate::count_velocities(const std::vector<Body>& bodies) {
  const std::size_t cells = velocities_[0].counts().size();
  std::vector<std::int64_t> counts(3 * cells, 0);
  for (const Body& body : bodies)
    if (body.velocity.squaredNorm() > moving_speed_ * moving_speed_)
      for (std::size_t a = 0; a < 3; ++a) ++counts[a * cells + velocities_[a].bin_of(body.velocity[a])];
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), static_cast<int>(counts.size()), MPI_INT64_T, MPI_SUM, communicator());
  for (std::size_t c = 0; c < counts.size(); ++c) velocities_[c / cells].counts()[c % cells] += counts[c];
}

std::vector<Diagnostic> TransportRate::diagnostics() const {
  std::vector<Diagnostic> diagnostics{{"q_s", "m^2/s", latest_.q_s}};
  if (scales_.have_q_star()) diagnostics.push_back({"q_star", "1", latest_.q_s / scales_.flux()});
  diagnostics.push_back({"moving_grains", "1", static_cast<double>(latest_.moving)});
  diagnostics.push_back({"moving_share", "1", latest_.share()});
  diagnostics.push_back({"activity", "m", latest_.activity});
  return diagnostics;
}

double TransportRate::interval() const {
  return q_s_.count() > 1 ? (last_time_ - first_time_) / static_cast<double>(q_s_.count() - 1) : 0.0;
}

std::vector<Diagnostic> TransportRate::results() const {
  const CorrelatedMean::Error error = q_s_.error();
  const TrendVerdict verdict = trend_of(q_s_);
  const double values = static_cast<double>(std::max<std::int64_t>(1, q_s_.count()));
  std::vector<Diagnostic> results{{"q_s_mean", "m^2/s", q_s_.mean()},
                                  {"q_s_deviation", "m^2/s", q_s_.deviation()},
                                  {"q_s_error", "m^2/s", error.of_mean},
                                  {"q_s_independent", "1", error.independent},
                                  {"q_s_error_holds", "1", error.holds() ? 1.0 : 0.0},
                                  {"q_s_correlation_time", "s", 0.5 * values / error.independent * interval()},
                                  {"q_s_drift", "m^2/s", verdict.drift},
                                  {"q_s_drift_error", "m^2/s", verdict.error},
                                  {"steady", "1", verdict.as_number()}};
  if (scales_.have_q_star()) {
    results.push_back({"q_star_mean", "1", q_s_.mean() / scales_.flux()});
    results.push_back({"q_star_deviation", "1", q_s_.deviation() / scales_.flux()});
    results.push_back({"q_star_error", "1", error.of_mean / scales_.flux()});
    results.push_back({"q_star_drift", "1", verdict.drift / scales_.flux()});
    results.push_back({"q_star_drift_error", "1", verdict.error / scales_.flux()});
  }
  results.push_back({"moving_grains_mean", "1", moving_.mean()});
  results.push_back({"moving_grains_error", "1", moving_.error().of_mean});
  results.push_back({"moving_share_mean", "1", sum_of_shares_ / values});
  results.push_back({"activity_mean", "m", sum_of_activity_ / values});
  for (const Diagnostic& of_hops : hops_.results()) results.push_back(of_hops);
  results.push_back({"measured_from", "s", first_time_});
  results.push_back({"measured_until", "s", last_time_});
  if (q_s_.count() == 0) forget_values(results);
  results.push_back({"reference_diameter", "m", scales_.grain_diameter});
  results.push_back({"reference_density", "kg/m^3", scales_.grain_density});
  results.push_back({"moving_speed", "m/s", moving_speed_});
  add_count(results);
  for (const Diagnostic& latest : diagnostics()) results.push_back(latest);
  results.push_back({"largest_grain_speed", "m/s", latest_.largest_speed});
  return results;
}

std::vector<std::string> TransportRate::remarks() const {
  if (q_s_.count() == 0) return {};
  const CorrelatedMean::Error error = q_s_.error();
  const double unit = scales_.have_q_star() ? scales_.flux() : 1.0;
  const std::string mean = fmt::format("transport: {} = {}{}", scales_.have_q_star() ? "q*" : "q_s",
                                       with_error(q_s_, unit), scales_.have_q_star() ? "" : " m^2/s");
  if (q_s_.count() == 1)
    return {fmt::format("{}, a single measurement, at {:.4g} s: an error needs at least two", mean, first_time_)};
  return {fmt::format("{}, deviation {:.2g}, from {:.4g} to {:.4g} s ({} measurements worth {:.3g} independent ones{})",
                      mean, q_s_.deviation() / unit, first_time_, last_time_, q_s_.count(), error.independent,
                      error.holds() ? "" : ": too few, the error is larger"),
          fmt::format("transport: {}", trend_of(q_s_).sentence(unit))};
}

std::vector<Profile> TransportRate::profiles() const {
  const std::span<const double> edges = velocities_[0].edges();
  Profile edge{"velocity_edges", "m/s", {"velocity_edges"}, {}, {edges.size()}, {edges.begin(), edges.end()}};
  Profile density{"velocity_density", "s/m", {"velocity_bin"}, {"x", "y", "z"}, {edges.size() - 1, 3}, {}};
  for (std::size_t b = 1; b < edges.size(); ++b)
    for (const Histogram& velocity : velocities_) {
      const auto all = static_cast<double>(std::max<std::int64_t>(1, velocity.total()));
      density.values.push_back(static_cast<double>(velocity.counts()[b]) / (all * (edges[b] - edges[b - 1])));
    }
  std::vector<Profile> profiles{edge, density};
  for (Profile& of_hops : hops_.profiles()) profiles.push_back(std::move(of_hops));
  return profiles;
}

// The latest measurement is saved too: a row of the series may come before the next.
std::vector<double> TransportRate::sums() const {
  return {first_time_,
          last_time_,
          sum_of_shares_,
          sum_of_activity_,
          latest_.q_s,
          latest_.activity,
          static_cast<double>(latest_.moving),
          static_cast<double>(latest_.grains),
          latest_.largest_speed};
}

SavedSettings TransportRate::settings() const {
  return {{"moving_speed", moving_speed_}, {"grain_diameter", scales_.grain_diameter}};
}

void TransportRate::save_sums(ArchiveWriter& archive, const std::string& group) const {
  write_whole(archive, communicator(), group + "/sums", sums());
  q_s_.save(archive, communicator(), group + "/q_s_batches");
  moving_.save(archive, communicator(), group + "/moving_batches");
  std::vector<std::int64_t> counts;
  for (const Histogram& velocity : velocities_)
    counts.insert(counts.end(), velocity.counts().begin(), velocity.counts().end());
  write_whole(archive, communicator(), group + "/velocity_counts", counts);
  hops_.save(archive, group);
}

bool TransportRate::load_sums(ArchiveReader& archive, const std::string& group) {
  const std::size_t cells = velocities_[0].counts().size();
  // Older checkpoints do not have all, or have other cells.
  if (!archive.has(group + "/velocity_counts") || !archive.has(group + "/q_s_batches")) return false;
  const auto counts = read_whole_if_alike<std::int64_t>(archive, group + "/velocity_counts", {3 * cells});
  if (!counts) return false;
  const auto sums = read_whole<double>(archive, group + "/sums", {this->sums().size()});
  first_time_ = sums.at(0);
  last_time_ = sums.at(1);
  sum_of_shares_ = sums.at(2);
  sum_of_activity_ = sums.at(3);
  latest_ = {sums.at(4), sums.at(5), std::llround(sums.at(6)), std::llround(sums.at(7)), sums.at(8)};
  q_s_.load(archive, group + "/q_s_batches");
  moving_.load(archive, group + "/moving_batches");
  restore_count(q_s_.count());
  for (std::size_t c = 0; c < counts->size(); ++c) velocities_[c / cells].counts()[c % cells] = (*counts)[c];
  hops_.load(archive, group, latest_.grains);
  return true;
}

void describe(SectionVisitor& visit, TransportRateKeys& keys) {
  visit.real("from", keys.from,
             {.unit = "s", .meaning = "start of the means, hops and distributions", .at_least = 0.0});
  visit.real("every", keys.every,
             {.unit = "s", .meaning = "between measurements; 0: with the rows of series.csv", .at_least = 0.0});
  describe_moving_speed(visit, keys.moving_speed);
}

void check(const TransportRateKeys&, const RunContext& run) { require_grains(run, "measure"); }

std::optional<std::string> warning(const TransportRateKeys& keys, const RunContext& run) {
  return fast_moving_speed(TransportRateKeys::section, keys.moving_speed, run);
}

std::unique_ptr<Observer> make_observer(const TransportRateKeys& keys, const RunContext& run,
                                        const RunningSystem& system) {
  return std::make_unique<TransportRate>(system.communicator, transport_scales(run), keys, run.grains->recirculation);
}

ObserverMemory memory_of(const TransportRateKeys&, const RunContext&, const RunSize& size) {
  return {.of_ids = size.ids * Hops::bytes_per_id()};
}

}  // namespace thalweg::analysis
