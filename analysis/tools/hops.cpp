#include "analysis/tools/hops.hpp"

#include "analysis/tools/sphere_in_layer.hpp"
#include "core/state/whole_dataset.hpp"
#include "core/sums/reproducible_sum.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::analysis {

namespace {

// Range in units of length and time. Grains that only jiggle in their places make hops of a thousandth of a diameter.
constexpr double shortest = 1e-4, longest = 1e3;
constexpr int bins = 140;  // 20 a decade

}  // namespace

std::vector<Body> free_bodies_of(const GrainView& grains) {
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < grains.id.size(); ++i)
    if (!grains.is_member(i) && !grains.velocity_is_held(i))
      bodies.push_back(
          {grains.id[i], volume_of(grains.radius[i], grains.disk_thickness), grains.position[i], grains.velocity[i]});
  for (const ClumpState& clump : grains.clumps)
    if (!clump.velocity_is_held) bodies.push_back({clump.id, clump.volume, clump.position, clump.velocity});
  return bodies;
}

Hops::Hops(MPI_Comm communicator, double length, double time, double moving_speed, bool recirculation)
    : communicator_(communicator),
      diameter_(length),
      moving_speed_(moving_speed),
      recirculation_(recirculation),
      lengths_(Histogram::geometric(shortest * length, longest * length, bins)),
      times_(Histogram::geometric(shortest * time, longest * time, bins)) {}

void Hops::observe(double time, const PeriodicBox& box, GlobalId id_count, const std::vector<Body>& bodies,
                   bool counts) {
  if (!homes_) homes_.emplace(communicator_, id_count);
  homes_->grow(id_count);
  memory_.resize(homes_->size());
  double fastest = 0.0;
  std::vector<Sighting> sightings;
  for (const Body& body : bodies) {
    const Vec3 &x = body.position, &v = body.velocity;
    sightings.push_back({body.id, x.x(), x.y(), x.z(), v.x(), v.y(), v.z()});
    fastest = std::max(fastest, v.norm());
  }
  fastest = max_over_ranks(communicator_, fastest);
  const double duration = time - last_time_;
  const Interval interval{time, duration, farthest_away(diameter_, std::max(fastest, last_speed_), duration), box,
                          counts};
  std::vector<double> ended;
  std::vector<Memory> latest(memory_.size());  // unseen, those that are no longer there
  for (const Sighting& seen : homes_->bring_home(sightings)) {
    const std::size_t place = homes_->location_of(seen.id);
    latest[place] = memory_[place];
    follow(latest[place], seen, interval, ended);
  }
  memory_ = std::move(latest);
  last_time_ = time;
  last_speed_ = fastest;
  take_in(ended);
}

void Hops::follow(Memory& memory, const Sighting& seen, const Interval& interval, std::vector<double>& ended) const {
  const Look now{{seen.x, seen.y, seen.z}, {seen.v_x, seen.v_y, seen.v_z}};
  const bool moves = now.velocity.squaredNorm() > moving_speed_ * moving_speed_;
  const Way gone = way_between(memory.latest, now, interval.duration, interval.box);
  if (recirculation_ && gone.away > interval.farthest) memory.phase = unseen;
  const bool known = memory.phase != unseen;
  if (memory.phase == hopping || memory.phase == hopping_uncounted) {
    memory.length += gone.way.x();
    if (!moves && memory.phase == hopping) ended.insert(ended.end(), {memory.length, interval.time - memory.begin});
    if (!moves) memory.phase = at_rest;
  } else if (moves) {
    memory.phase = known && interval.counts ? hopping : hopping_uncounted;
    memory.begin = interval.time;
    memory.length = known ? gone.way.x() : 0.0;
  } else {
    memory.phase = at_rest;
  }
  memory.latest = now;
}

// ended: length and time of each hop that has ended at a home here.
void Hops::take_in(const std::vector<double>& ended) {
  const std::size_t cells = lengths_.counts().size();
  std::vector<std::int64_t> counts(2 * cells, 0);
  for (std::size_t n = 0; n < ended.size(); n += 2) {
    ++counts[lengths_.bin_of(std::abs(ended[n]))];
    ++counts[cells + times_.bin_of(ended[n + 1])];
  }
  MPI_Allreduce(MPI_IN_PLACE, counts.data(), static_cast<int>(counts.size()), MPI_INT64_T, MPI_SUM, communicator_);
  for (std::size_t b = 0; b < cells; ++b) {
    lengths_.counts()[b] += counts[b];
    times_.counts()[b] += counts[cells + b];
  }
  const std::vector<double> sums = reproducible_sums(communicator_, ended, 2);
  sum_of_lengths_ += sums[0];
  sum_of_times_ += sums[1];
}

std::vector<Diagnostic> Hops::results() const {
  const auto count = static_cast<double>(lengths_.total());
  const auto of_hops = [count](double value) { return count > 0.0 ? value : std::nan(""); };
  return {{"hops", "1", count},
          {"hop_length_mean", "m", of_hops(sum_of_lengths_ / count)},
          {"hop_length_10", "m", of_hops(lengths_.quantile(0.1))},
          {"hop_length_50", "m", of_hops(lengths_.quantile(0.5))},
          {"hop_length_90", "m", of_hops(lengths_.quantile(0.9))},
          {"hop_time_mean", "s", of_hops(sum_of_times_ / count)},
          {"hop_time_10", "s", of_hops(times_.quantile(0.1))},
          {"hop_time_50", "s", of_hops(times_.quantile(0.5))},
          {"hop_time_90", "s", of_hops(times_.quantile(0.9))}};
}

std::vector<Profile> Hops::profiles() const {
  const auto values = [](auto numbers) { return std::vector<double>(numbers.begin(), numbers.end()); };
  std::vector<Profile> profiles{{"hop_length_edges", "m", {"hop_length_edges"}, {}, {}, values(lengths_.edges())},
                                {"hop_length_count", "1", {"hop_length_bin"}, {}, {}, values(lengths_.counts())},
                                {"hop_time_edges", "s", {"hop_time_edges"}, {}, {}, values(times_.edges())},
                                {"hop_time_count", "1", {"hop_time_bin"}, {}, {}, values(times_.counts())}};
  for (Profile& profile : profiles) profile.shape = {profile.values.size()};
  return profiles;
}

void Hops::save(ArchiveWriter& archive, const std::string& group) const {
  archive.attribute(group + "/hops_last_time", last_time_);
  archive.attribute(group + "/hops_largest_speed", last_speed_);
  archive.attribute(group + "/hops_sum_of_lengths", sum_of_lengths_);
  archive.attribute(group + "/hops_sum_of_times", sum_of_times_);
  std::vector<std::int64_t> counts(lengths_.counts().begin(), lengths_.counts().end());
  counts.insert(counts.end(), times_.counts().begin(), times_.counts().end());
  write_whole(archive, communicator_, group + "/hops_counts", counts);
  if (!homes_) return;
  std::vector<double> rows;
  for (const Memory& m : memory_)
    rows.insert(rows.end(),
                {static_cast<double>(m.phase), m.latest.position.x(), m.latest.position.y(), m.latest.position.z(),
                 m.latest.velocity.x(), m.latest.velocity.y(), m.latest.velocity.z(), m.begin, m.length});
  homes_->write(archive, group + "/hops_of_bodies", std::move(rows), columns);
}

void Hops::load(ArchiveReader& archive, const std::string& group, std::int64_t bodies) {
  const std::size_t cells = lengths_.counts().size();
  const std::string grains = group + "/hops_of_bodies";
  if (!archive.has(group + "/hops_largest_speed") && !archive.has(grains)) return;
  const auto counts = read_whole_if_alike<std::int64_t>(archive, group + "/hops_counts", {2 * cells});
  if (!counts || (bodies == 0 && !archive.has(grains))) return;
  last_time_ = archive.real_attribute(group + "/hops_last_time");
  last_speed_ = archive.real_attribute(group + "/hops_largest_speed");
  sum_of_lengths_ = archive.real_attribute(group + "/hops_sum_of_lengths");
  sum_of_times_ = archive.real_attribute(group + "/hops_sum_of_times");
  std::copy(counts->begin(), counts->begin() + static_cast<std::ptrdiff_t>(cells), lengths_.counts().begin());
  std::copy(counts->begin() + static_cast<std::ptrdiff_t>(cells), counts->end(), times_.counts().begin());
  homes_ = DistributionById::of_rows(communicator_, archive, grains, bodies);
  memory_.assign(homes_->size(), {});
  const auto rows = homes_->read<double>(archive, grains, columns);
  for (std::size_t m = 0; m < memory_.size(); ++m) {
    const double* row = rows.data() + m * columns;
    memory_[m] = {static_cast<Phase>(static_cast<int>(row[0])),
                  {{row[1], row[2], row[3]}, {row[4], row[5], row[6]}},
                  row[7],
                  row[8]};
  }
}

}  // namespace thalweg::analysis
