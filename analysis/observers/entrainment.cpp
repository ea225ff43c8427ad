#include "analysis/observers/entrainment.hpp"

#include "analysis/observer/mean_observer.hpp"
#include "analysis/tools/sphere_in_layer.hpp"
#include "analysis/tools/way_between.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/parallel/ranks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace thalweg::analysis {

Entrainment::Entrainment(MPI_Comm communicator, const PeriodicBox& box, EntrainmentSettings settings)
    : communicator_(communicator),
      box_(box),
      settings_(std::move(settings)),
      layers_(communicator, box, settings_.window, 0.0, settings_.obstacles) {
  settings_.obstacles = {};  // the layers have what they need of them, and surfaces may be large
}

void Entrainment::observe(const Snapshot& snapshot) {
  if (snapshot.step <= seen_step_ || !counts_from(settings_.from, snapshot.time)) return;
  seen_step_ = snapshot.step;
  if (!homes_) homes_.emplace(communicator_, snapshot.grains.end_of_ids());
  homes_->grow(snapshot.grains.end_of_ids());
  memory_.resize(homes_->size());
  const bool due = settings_.grains.empty() && snapshot.step - chosen_step_ >= settings_.refresh_steps;
  const BodiesHere bodies(snapshot);
  if (chosen_step_ < 0 || due) choose(snapshot, bodies);
  count(take_samples(snapshot, bodies), snapshot.time);
}

bool Entrainment::is_listed(GlobalId id) const {
  return std::binary_search(settings_.grains.begin(), settings_.grains.end(), id);
}

void Entrainment::choose(const Snapshot& snapshot, const BodiesHere& bodies) {
  chosen_step_ = snapshot.step;
  const std::span<const GlobalId> ids = bodies.ids();
  std::vector<char> chosen(ids.size(), 0);
  if (settings_.grains.empty()) {
    const double lowest = layers_.bed(snapshot).height - settings_.diameter;
    for (std::size_t b = 0; b < chosen.size(); ++b)
      chosen[b] = bodies.position(b).z() > lowest && !is_held(settings_.held, ids[b]);
  } else {
    for (std::size_t b = 0; b < chosen.size(); ++b) chosen[b] = is_listed(ids[b]);
  }
  watch(ids, std::move(chosen));
}

// ids: of the grains and clumps here. Those watched before are remembered on. Listed ones are also watched where they
// are not here, between a sink and their return.
void Entrainment::watch(std::span<const GlobalId> ids, std::vector<char> chosen) {
  struct Watched {
    GlobalId id;
  };
  std::vector<Watched> rows;
  for (std::size_t n = 0; n < ids.size(); ++n)
    if (chosen[n] != 0) rows.push_back({ids[n]});
  watched_here_.set(ids, std::move(chosen));
  std::vector<char> at_home(memory_.size(), 0);
  for (const Watched& row : homes_->bring_home(rows)) at_home[homes_->location_of(row.id)] = 1;
  std::int64_t count = 0;
  for (std::size_t m = 0; m < memory_.size(); ++m) {
    const bool watched = at_home[m] != 0 || is_listed(homes_->id_at(m));
    if (watched != memory_[m].watched) memory_[m] = Memory{};
    memory_[m].watched = watched;
    count += watched ? 1 : 0;
  }
  watched_count_ = sum_over_ranks(communicator_, count);
}

// Brings states and contacts of the watched grains to their homes. Returns the ids of those here that have started,
// ascending.
std::vector<GlobalId> Entrainment::take_samples(const Snapshot& snapshot, const BodiesHere& bodies) {
  const GrainView& grains = snapshot.grains;
  const std::vector<char>& watched = watched_here_.flags(
      communicator_, bodies.ids(), *homes_, [this](GlobalId id) { return memory_[homes_->location_of(id)].watched; });
  std::vector<Seen> seen;
  for (std::size_t b = 0; b < watched.size(); ++b) {
    if (watched[b] == 0) continue;
    BodiesHere::State state = bodies.state(b);
    const Vec3 of_gradient = volume_of(state.radius, grains.disk_thickness) * grains.force_density;
    state.record.set(GrainRecord::fluid_force, state.record[GrainRecord::fluid_force] + of_gradient);
    seen.push_back({bodies.ids()[b], state.radius, state.mass, state.record});
  }
  std::vector<char> chosen(grains.id.size(), 0);
  for (std::size_t n = 0; n < chosen.size(); ++n) chosen[n] = watched[bodies.body_of(n)];
  std::vector<TouchRow> touches;
  if (snapshot.contacts)
    snapshot.contacts->for_each_contact_of(chosen, [&](std::size_t n, const ContactEnd& end) {
      const GlobalId member = grains.is_member(n) ? grains.id[n] : -1;
      touches.push_back(row_of(bodies.ids()[bodies.body_of(n)], {end.partner, end.arm, end.force, end.to_partner.norm(),
                                                                 member, bodies.from_centre(n)}));
    });
  std::vector<GlobalId> came;
  for (const Seen& one : homes_->bring_home(seen)) {
    remember(memory_[homes_->location_of(one.id)], one, snapshot.time);
    came.push_back(one.id);
  }
  for (const TouchRow& row : homes_->bring_home(touches))
    memory_[homes_->location_of(row.id)].ring.back().touches.push_back(touch_of(row));
  std::sort(came.begin(), came.end());
  std::erase_if(came, [this](GlobalId id) { return !starts(memory_[homes_->location_of(id)]); });
  return came;
}

// A grain that was away for a sample, or is farther from its place than it can have gone (way_between.hpp).
bool Entrainment::has_come_in_anew(const GrainSample& last, const Seen& seen, double time) const {
  if (!settings_.recirculation) return false;
  const double duration = time - last.time;
  constexpr double longest = 2.5;  // intervals: a sample is late by less than a step
  if (duration > longest * settings_.interval) return true;
  const Look before{last[GrainRecord::position], last[GrainRecord::velocity]},
      now{seen.record[GrainRecord::position], seen.record[GrainRecord::velocity]};
  const double fastest = std::max(before.velocity.norm(), now.velocity.norm());
  return way_between(before, now, duration, box_).away > farthest_away(settings_.diameter, fastest, duration);
}

void Entrainment::remember(Memory& memory, const Seen& seen, double time) const {
  if (!memory.ring.empty() && has_come_in_anew(memory.ring.back(), seen, time)) {
    memory = Memory{};
    memory.watched = true;
  }
  memory.radius = seen.radius;
  memory.mass = seen.mass;
  GrainSample sample{time, seen.record, {}};
  if (!memory.ring.empty()) {
    const Vec3 last = memory.ring.back()[GrainRecord::position];
    Vec3 position = seen.record[GrainRecord::position];
    for (int axis = 0; axis < 3; ++axis)
      if (box_.periodic[static_cast<std::size_t>(axis)])
        position[axis] += box_.size[axis] * std::round((last[axis] - position[axis]) / box_.size[axis]);
    sample.record.set(GrainRecord::position, position);
  }
  memory.ring.push_back(std::move(sample));
  const double oldest = time - settings_.memory - 0.5 * settings_.interval;
  while (memory.ring.front().time < oldest) memory.ring.pop_front();
}

// True if the grain has just left its rest place.
bool Entrainment::starts(Memory& memory) const {
  const GrainSample& now = memory.ring.back();
  const Vec3 position = now[GrainRecord::position];
  if (now[GrainRecord::velocity].norm() > settings_.moving_speed)
    memory.quiet_since = -1.0;
  else if (memory.quiet_since < 0.0)
    memory.quiet_since = now.time;
  if (memory.phase == at_rest) {
    if ((position - memory.rest).norm() <= settings_.displacement * 2.0 * memory.radius) return false;
    memory.phase = moving;
    return true;
  }
  if (memory.quiet_since >= 0.0 && now.time - memory.quiet_since >= settings_.rest_time * (1.0 - 1e-9)) {
    memory.phase = at_rest;
    memory.rest = position;
  }
  return false;
}

EntrainedGrain Entrainment::grain_of(const Start& start) const {
  return {start.id, start.radius, Vec3(start.rest[0], start.rest[1], start.rest[2]),
          settings_.weight(start.mass, start.radius), settings_.buoyancy(start.mass, start.radius)};
}

// started: ids whose home is here, ascending. Events are in the order of ids.
void Entrainment::count(const std::vector<GlobalId>& started, double time) {
  if (sum_over_ranks(communicator_, static_cast<std::int64_t>(started.size())) == 0) return;
  std::vector<Start> starts_here;
  for (const GlobalId id : started) {
    const Memory& memory = memory_[homes_->location_of(id)];
    Start start{id, memory.radius, memory.mass, 0.0, true, {memory.rest.x(), memory.rest.y(), memory.rest.z()}};
    const Entraining found = entraining_of(grain_of(start), memory.ring, settings_.moving_speed);
    start.share = found.couple_share();
    start.has_onset = found.onset.has_value();
    starts_here.push_back(start);
  }
  const std::vector<GrainRing> rings = rings_on_first_rank(started);
  const std::vector<Start> starts = Ranks(communicator_).gathered(std::move(starts_here));
  std::vector<std::size_t> order(starts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return starts[a].id < starts[b].id; });
  for (const std::size_t number : order) {
    const Start& start = starts[number];
    ++events_;
    if (!start.has_onset) ++without_onset_;
    if (std::isfinite(start.share)) {
      ++shares_;
      sum_of_shares_ += start.share;
      sum_of_squares_ += start.share * start.share;
    }
    if (rank_of(communicator_) != 0) continue;
    const EntrainedGrain grain = grain_of(start);
    const GrainRing& ring = rings[number];
    pending_.push_back(event_of(fmt::format("event_{:06d}", events_), grain, ring,
                                entraining_of(grain, ring, settings_.moving_speed)));
    pending_.back().time = time;
  }
}

// The rings of all grains that have started, in the order of ids; on rank 0.
std::vector<GrainRing> Entrainment::rings_on_first_rank(const std::vector<GlobalId>& started) const {
  std::vector<SampleRow> samples;
  std::vector<TouchRow> touches;
  for (const GlobalId id : started) add_rows(id, memory_[homes_->location_of(id)].ring, samples, touches);
  samples = exchange_rows(communicator_, samples, std::vector<int>(samples.size(), 0));
  touches = exchange_rows(communicator_, touches, std::vector<int>(touches.size(), 0));
  std::vector<GrainRing> rings;
  auto next = touches.cbegin();
  for (std::size_t n = 0; n < samples.size(); ++n) {
    if (n == 0 || samples[n].id != samples[n - 1].id) rings.emplace_back();
    rings.back().push_back(sample_of(samples[n], next));
  }
  return rings;
}

std::vector<Diagnostic> Entrainment::diagnostics() const {
  return {{"watched_grains", "1", static_cast<double>(watched_count_)},
          {"entrainments", "1", static_cast<double>(events_)}};
}

Entrainment::Shares Entrainment::shares() const {
  Shares found;
  if (shares_ == 0) return found;
  const auto n = static_cast<double>(shares_);
  found.mean = sum_of_shares_ / n;
  if (shares_ == 1) return found;
  found.deviation = std::sqrt(std::max(0.0, (sum_of_squares_ - n * found.mean * found.mean) / (n - 1.0)));
  found.error = found.deviation / std::sqrt(n);
  return found;
}

std::vector<Diagnostic> Entrainment::results() const {
  const Shares found = shares();
  std::vector<Diagnostic> results = diagnostics();
  results.push_back({"entrainments_without_onset", "1", static_cast<double>(without_onset_)});
  results.push_back({"entrainments_with_share", "1", static_cast<double>(shares_)});
  results.push_back({"couple_share_mean", "1", found.mean});
  results.push_back({"couple_share_deviation", "1", found.deviation});
  results.push_back({"couple_share_error", "1", found.error});
  return results;
}

std::vector<std::string> Entrainment::remarks() const {
  if (events_ == 0) return {"entrainment: no watched grain has left its place"};
  std::string text = fmt::format("entrainment: {} start{}", events_, events_ == 1 ? "" : "s");
  const Shares found = shares();
  if (shares_ > 0) text += fmt::format("; the fluid's couple is {:.3g} of its torque about the hinge", found.mean);
  if (shares_ > 1) text += fmt::format(", +- {:.2g} (standard error of {} starts)", found.error, shares_);
  if (without_onset_ > 0)
    text += fmt::format(
        "; {} began before the recorded {:g} s and {} left out of the mean: give a longer analysis.entrainment.memory",
        without_onset_, settings_.memory, without_onset_ == 1 ? "is" : "are");
  return {text};
}

Records Entrainment::take_records() {
  Records records;
  records.events = std::move(pending_);
  pending_.clear();
  return records;
}

}  // namespace thalweg::analysis
