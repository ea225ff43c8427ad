#include "analysis/reach/reach.hpp"

#include "analysis/observer/mean_observer.hpp"
#include "core/parallel/mpi_count.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/sums/reproducible_sum.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

namespace thalweg::analysis {

namespace {

constexpr double pixels_across_diameter = 25.0;

// A whole number of columns of pixels makes a bin.
double pixel_of(const Sections& sections, double wanted) {
  return sections.spacing() / std::max(1.0, std::ceil(sections.spacing() / wanted * (1.0 - 1e-9)));
}

// Time (s) after which a record is complete: half a look before its last one, so that as many looks make every record
// wherever in a step they fall.
double time_of_record(const ReachKeys& keys) {
  return (std::ceil(keys.record_every / keys.every * (1.0 - 1e-9)) - 0.5) * keys.every;
}

Sections sections_of(const PeriodicBox& box, const ReachKeys& keys, double diameter) {
  return {box.size.x(), keys.sections.value_or(default_sections(box.size.x(), diameter)), box.periodic[0]};
}

StaticPixels pixels_of(MPI_Comm communicator, const PeriodicBox& box, const ReachKeys& keys, double diameter) {
  return {communicator, box,
          pixel_of(sections_of(box, keys, diameter), keys.pixel.value_or(diameter / pixels_across_diameter)),
          time_of_record(keys)};
}

std::vector<std::int64_t> summed(MPI_Comm communicator, std::vector<std::int64_t> counts) {
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), mpi_count(counts.size()), MPI_INT64_T, MPI_SUM, communicator);
  return counts;
}

void add_to(CorrelatedMean& mean, const std::vector<double>& values) {
  double sum = 0.0, count = 0.0;
  for (const double value : values)
    if (!std::isnan(value)) sum += value, ++count;
  if (count > 0.0) mean.add(sum / count);
}

}  // namespace

void PassageSums::add(const PassageSums& more) {
  for (std::size_t n = 0; n < grains.size(); ++n) {
    grains[n] += more.grains[n];
    volume[n] += more.volume[n];
  }
}

std::int64_t PassageSums::all_grains_of(Passage passage) const {
  const auto first = grains.begin() + static_cast<std::ptrdiff_t>(slot(passage, 0));
  return std::accumulate(first, first + static_cast<std::ptrdiff_t>(places_), std::int64_t{0});
}

double PassageSums::all_volume_of(Passage passage) const {
  const auto first = volume.begin() + static_cast<std::ptrdiff_t>(slot(passage, 0));
  return std::accumulate(first, first + static_cast<std::ptrdiff_t>(places_), 0.0);
}

Reach::Reach(MPI_Comm communicator, const PeriodicBox& box, const TransportScales& scales, const ReachKeys& keys,
             double disk_thickness, bool recirculation, std::vector<GlobalId> obstacles)
    : communicator_(communicator),
      scales_(scales),
      sections_(sections_of(box, keys, scales.grain_diameter)),
      width_(disk_thickness > 0.0 ? disk_thickness : box.size.y()),
      from_(keys.from),
      every_(keys.every),
      record_every_(keys.record_every),
      moving_speed_(keys.moving_speed.value_or(scales.moving_speed())),
      obstacles_(std::move(obstacles)),
      pixels_(pixels_of(communicator, box, keys, scales.grain_diameter)),
      book_(communicator, sections_, scales.grain_diameter, moving_speed_, recirculation),
      residence_(communicator, sections_.length / scales.fall_speed()),
      interval_(sections_.size()),
      window_(sections_.size()),
      total_(sections_.size()),
      first_grains_(sections_.size(), 0),
      here_(sections_.size(), 0),
      first_stored_(sections_.size(), 0.0),
      stored_(sections_.size(), 0.0),
      window_stored_(sections_.size(), 0.0),
      q_s_(sections_.size()),
      level_(sections_.size()) {}

void Reach::observe(const Snapshot& snapshot) {
  if (snapshot.step <= seen_step_) return;
  const bool first = seen_step_ < 0;
  seen_step_ = snapshot.step;
  const std::vector<Body> bodies = free_bodies_of(snapshot.grains);
  const bool complete = pixels_.look(snapshot, obstacles_.in_the_bed(snapshot));
  const GrainBook::Page page =
      book_.look(snapshot.time, snapshot.decomposition->box(), snapshot.grains.end_of_ids(), bodies);
  const std::int64_t arrived_before = interval_.all_grains_of(Passage::arrived);
  count(page);
  residence_.take(snapshot.time, interval_.all_grains_of(Passage::arrived) - arrived_before, page.stays);
  here_ = grains_in_bins(bodies);
  if (first) first_grains_ = here_;
  if (!first && !complete) return;
  const std::vector<double> before = std::exchange(stored_, stored_in_bins(bodies));
  if (first) first_stored_ = stored_;
  if (complete) end_record(snapshot.time, before);
}

// Adds what the grains have done to the record under way.
void Reach::count(const GrainBook::Page& page) {
  std::vector<std::int64_t> grains(interval_.grains.size(), 0);
  for (const GrainBook::Entry& entry : page.entries)
    ++grains[interval_.slot(entry.passage, static_cast<std::size_t>(entry.place))];
  grains = summed(communicator_, std::move(grains));
  std::transform(grains.begin(), grains.end(), interval_.grains.begin(), interval_.grains.begin(), std::plus<>());
  if (std::all_of(grains.begin(), grains.end(), [](std::int64_t some) { return some == 0; })) return;
  const std::vector<double> volumes =
      reproducible_sums_by_bin(communicator_, static_cast<int>(interval_.volume.size()), 1, [&](const TermTaker& take) {
        for (const GrainBook::Entry& entry : page.entries)
          take(static_cast<int>(interval_.slot(entry.passage, static_cast<std::size_t>(entry.place))),
               {&entry.volume, 1});
      });
  std::transform(volumes.begin(), volumes.end(), interval_.volume.begin(), interval_.volume.begin(), std::plus<>());
}

std::vector<std::int64_t> Reach::grains_in_bins(const std::vector<Body>& bodies) const {
  std::vector<std::int64_t> grains(sections_.size(), 0);
  for (const Body& body : bodies) ++grains[static_cast<std::size_t>(sections_.bin_of(body.position.x()))];
  return summed(communicator_, std::move(grains));
}

std::vector<double> Reach::stored_in_bins(const std::vector<Body>& bodies) const {
  std::vector<double> stored =
      reproducible_sums_by_bin(communicator_, static_cast<int>(sections_.size()), 1, [&](const TermTaker& take) {
        for (const Body& body : bodies) take(static_cast<int>(sections_.bin_of(body.position.x())), {&body.volume, 1});
      });
  for (double& height : stored) height /= plan_of_bin();
  return stored;
}

std::vector<double> Reach::levels() const {
  const std::size_t columns = static_cast<std::size_t>(pixels_.columns()) / sections_.size();
  std::vector<double> levels;
  for (std::size_t bin = 0; bin < sections_.size(); ++bin) {
    double sum = 0.0, count = 0.0;
    for (std::size_t c = bin * columns; c < (bin + 1) * columns; ++c)
      if (StaticPixels::is_static(pixels_.surface()[c])) sum += pixels_.surface()[c], ++count;
    levels.push_back(count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN());
  }
  return levels;
}

std::vector<double> Reach::rates(const PassageSums& sums, Passage passage, double duration) const {
  std::vector<double> rates;
  for (std::size_t bin = 0; bin < sections_.size(); ++bin)
    rates.push_back(sums.volume_of(passage, bin) / (plan_of_bin() * duration));
  return rates;
}

void Reach::end_record(double time, const std::vector<double>& stored_before) {
  const double begun = pixels_.begun(), duration = time - begun;
  Row row{time, duration, {}, {}, levels(), stored_, {}, {}, {}, {}};
  for (std::size_t k = sections_.first(); k < sections_.size(); ++k) {
    const double upstream = interval_.volume_of(Passage::upstream, k) / (width_ * duration);
    row.q_s.push_back(interval_.volume_of(Passage::downstream, k) / (width_ * duration) - upstream);
    row.upstream_q_s.push_back(upstream);
  }
  row.entrained = rates(interval_, Passage::entrained, duration);
  row.deposited = rates(interval_, Passage::deposited, duration);
  row.arrived = rates(interval_, Passage::arrived, duration);
  row.left = rates(interval_, Passage::left, duration);
  if (counts_from(from_, begun)) {
    if (mean_q_s_.count() == 0) window_begun_ = begun, window_stored_ = stored_before;
    window_ended_ = time;
    window_.add(interval_);
    for (std::size_t k = 0; k < row.q_s.size(); ++k) q_s_[sections_.first() + k].add(row.q_s[k]);
    for (std::size_t bin = 0; bin < row.bed_level.size(); ++bin) add_to(level_[bin], {row.bed_level[bin]});
    add_to(mean_q_s_, row.q_s);
    add_to(mean_level_, row.bed_level);
  }
  total_.add(interval_);
  interval_ = PassageSums(sections_.size());
  if (rank_of(communicator_) == 0) rows_.push_back(std::move(row));
}

std::int64_t Reach::balance_residual() const {
  PassageSums all = total_;
  all.add(interval_);
  const auto net = [&](std::size_t section) {
    return all.grains_of(Passage::downstream, section) - all.grains_of(Passage::upstream, section);
  };
  std::int64_t residual = 0;
  for (std::size_t bin = 0; bin < sections_.size(); ++bin) {
    const std::int64_t gained = net(bin) - net((bin + 1) % sections_.size()) + all.grains_of(Passage::arrived, bin) -
                                all.grains_of(Passage::left, bin);
    residual += std::abs(here_[bin] - first_grains_[bin] - gained);
  }
  return residual;
}

ObserverMemory memory_of(const ReachKeys& keys, const RunContext& run, const RunSize& size) {
  const StaticPixels pixels = pixels_of(MPI_COMM_SELF, run.box, keys, run.grains->reference_diameter);
  const double largest = run.grains->largest_diameter;
  return {.of_ids = size.ids * (GrainBook::bytes_per_id() + pixels.bytes_per_id(largest)),
          .while_saved = size.ids * pixels.saved_bytes_per_id(largest)};
}

}  // namespace thalweg::analysis
