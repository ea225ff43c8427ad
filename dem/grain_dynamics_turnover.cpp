// Grains that come into the box and leave it (dem/supply): the part of GrainDynamics that changes who is there.
#include "core/base/error.hpp"
#include "core/base/round_off.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/state/whole_dataset.hpp"
#include "dem/contact/wall_touches.hpp"
#include "dem/grain_dynamics.hpp"
#include "dem/ranks/grain_archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace thalweg::dem {

bool GrainDynamics::turn_over(const std::function<Vec3(const Vec3&)>& fluid_velocity) {
  if (!turnover_.any()) return false;
  const auto scope = timer_.measure(lists_phase_);
  wrap_positions();
  // What leaves now comes in again in the next step at the earliest, so that everyone sees it gone.
  const std::vector<PlaceSeeker> seekers = turnover_.due(time());
  const std::vector<char> leaves = slots_in_sinks();
  const bool some_leave =
      any_rank(communicator_, std::any_of(leaves.begin(), leaves.end(), [](char l) { return l != 0; }));
  std::vector<TravellingBody> leaving;
  if (some_leave) leaving = take_leaving(leaves);
  for (const TravellingBody& body : leaving)
    turnover_.leave(body, static_cast<std::size_t>(turnover_.sink_at(body.centre())), time());

  std::vector<Arrival> arriving;
  if (!seekers.empty()) {
    const bool above_bed = std::any_of(seekers.begin(), seekers.end(), [](const PlaceSeeker& seeker) {
      return seeker.entrance->above_bed.has_value();
    });
    const std::vector<char> in_bed = above_bed ? slots_in_bed() : std::vector<char>(store_.owned);
    const std::vector<std::optional<FreePlace>> places = free_places(
        seekers, {store_, leaves, in_bed}, surroundings(), static_cast<std::uint64_t>(steps_done_), communicator_);
    turnover_.enter(seekers, places);
    for (std::size_t n = 0; n < seekers.size(); ++n) {
      if (!places[n]) continue;
      arriving.push_back({seekers[n].body, seekers[n].entrance->velocity, places[n]->at_own_height});
      arriving.back().body.place(places[n]->centre, box_);
    }
  }
  if (leaving.empty() && arriving.empty()) return false;
  exchange_bodies(leaves, leaving, arriving, fluid_velocity);
  return true;
}

// A mark for each owned grain: 1 if it is in a sink, a member if its clump is.
std::vector<char> GrainDynamics::slots_in_sinks() const {
  const auto in_sink = [this](const Vec3& centre) { return static_cast<char>(turnover_.sink_at(centre) >= 0); };
  std::vector<char> marks(store_.owned);
  for (std::size_t s = 0; s < store_.owned; ++s)
    if (store_.clump[s] < 0 && !holds_translation(store_.motion[s])) marks[s] = in_sink(store_.position[s]);
  for (std::size_t n = 0; n < clumps_.size(); ++n)
    if (!holds_translation(clumps_[n].motion))
      std::fill_n(marks.begin() + static_cast<std::ptrdiff_t>(clumps_.first_slot(n)), clumps_.member_count(n),
                  in_sink(clumps_[n].centre));
  return marks;
}

// A mark for each owned grain: 1 if it is part of the bed, as it is held or touches something; a member of a clump if
// any member does. What has just come in touches nothing yet.
std::vector<char> GrainDynamics::slots_in_bed() const {
  std::vector<char> touches(store_.total());
  for (const PairContact& c : list_.pairs)
    if (box_.difference(store_.position[c.first], store_.position[c.second]).squaredNorm() < c.reach * c.reach)
      touches[c.first] = touches[c.second] = 1;
  const auto look = [&](const WallTouch& touch) {
    if (touch.view.distance < store_.radius[touch.slot]) touches[touch.slot] = 1;
  };
  for_each_wall_touch(store_, list_, surroundings(), look);
  for_each_solid_touch(store_, list_, surroundings(), 0.0, look);
  for (std::size_t n = 0; n < clumps_.size(); ++n) {
    const auto first = touches.begin() + static_cast<std::ptrdiff_t>(clumps_.first_slot(n)),
               last = first + static_cast<std::ptrdiff_t>(clumps_.member_count(n));
    if (std::find(first, last, 1) != last) std::fill(first, last, 1);
  }
  std::vector<char> marks(store_.owned);
  for (std::size_t s = 0; s < store_.owned; ++s)
    marks[s] = touches[s] != 0 || holds_translation(store_.motion[s]) ? 1 : 0;
  return marks;
}

// The bodies of all ranks that leave, in order of id. Collective.
std::vector<TravellingBody> GrainDynamics::take_leaving(std::span<const char> leaves) const {
  std::vector<ClumpRow> clumps;
  for (std::size_t n = 0; n < clumps_.size(); ++n)
    if (leaves[clumps_.first_slot(n)] != 0) clumps.push_back(row_of(clumps_[n]));
  return gathered_bodies(marked_grains(store_, leaves).rows, std::move(clumps), communicator_);
}

// Takes the marked grains, those of the bodies that leave, out of the store and puts others in, each on the rank of its
// centre.
void GrainDynamics::exchange_bodies(std::span<const char> leaves, std::span<const TravellingBody> leaving,
                                    std::span<const Arrival> arriving,
                                    const std::function<Vec3(const Vec3&)>& fluid_velocity) {
  ContactHistories histories = histories_of(list_, store_, planes_.size());
  std::vector<Clump> clumps;
  for (std::size_t n = 0; n < clumps_.size(); ++n)
    if (leaves[clumps_.first_slot(n)] == 0) clumps.push_back(clumps_[n]);
  GrainBatch batch;
  for (const Arrival& arrival : arriving) {
    TravellingBody body = arrival.body;
    const Vec3 centre = body.centre();
    if (decomposition_.owner_of(centre) != rank_of(communicator_)) continue;
    if (arrival.velocity)
      body.set_velocity(*arrival.velocity);
    else if (!arrival.keeps_motion)
      body.set_velocity(fluid_velocity ? fluid_velocity(centre) : Vec3(Vec3::Zero()));
    batch.rows.insert(batch.rows.end(), body.rows.begin(), body.rows.end());
    if (body.clump) clumps.push_back(clump_of(*body.clump));
  }
  batch.attached.resize(batch.rows.size() * store_.attached_width, 0.0);
  sort_by_id(batch, static_cast<int>(store_.attached_width));
  std::sort(clumps.begin(), clumps.end(), [](const Clump& a, const Clump& b) { return a.id < b.id; });

  for (const Arrival& arrival : arriving) count_body(arrival.body, 1);
  for (const TravellingBody& body : leaving) count_body(body, -1);
  replace_marked(store_, leaves, batch);
  clumps_.replace(std::move(clumps));
  clumps_.find_members(store_);
  rebuild_with(std::move(histories));
  const std::int64_t here = sum_over_ranks(communicator_, static_cast<std::int64_t>(store_.owned));
  if (here != global_count_)
    throw RunError(
        fmt::format("There are {} grains and members of clumps in the box, but {} by the balance of supplies and "
                    "sinks; this is an error in the program.",
                    here, global_count_));
}

// Enters a body that comes (sign 1) or goes (-1) in the counts of all ranks.
void GrainDynamics::count_body(const TravellingBody& body, int sign) {
  const std::int64_t rows = sign * static_cast<std::int64_t>(body.rows.size());
  global_count_ += rows;
  if (body.clump) member_count_ += rows, clump_count_ += sign;
}

std::vector<Diagnostic> GrainDynamics::turnover_diagnostics() const {
  if (!turnover_.any()) return {};
  std::vector<Diagnostic> diagnostics{{"grains", "1", static_cast<double>(body_count())}};
  for (const Diagnostic& diagnostic : turnover_.diagnostics(time())) diagnostics.push_back(diagnostic);
  return diagnostics;
}

static std::string rate_name(const std::string& group, std::size_t supply) {
  return fmt::format("{}/supply_{}_rate", group, supply);
}

// Attributes: first_supplied_id, largest_radius and largest_offset of any grain so far, bodies and mass of each supply
// and sink, and the rate of each supply.
void GrainDynamics::save_turnover(ArchiveWriter& archive, const std::string& group) const {
  if (!turnover_.any()) return;
  const Turnover::State& state = turnover_.state();
  archive.attribute(group + "/first_supplied_id", turnover_.first_id());
  archive.attribute(group + "/largest_radius", largest_radius_);
  archive.attribute(group + "/largest_offset", largest_offset_);
  for (const auto& [name, tallies] : {std::pair{"supply", &state.supplied}, std::pair{"sink", &state.taken}})
    for (std::size_t n = 0; n < tallies->size(); ++n) {
      archive.attribute(fmt::format("{}/{}_{}_bodies", group, name, n), (*tallies)[n].bodies);
      archive.attribute(fmt::format("{}/{}_{}_mass", group, name, n), (*tallies)[n].mass);
    }
  for (std::size_t n = 0; n < parameters_.supplies.size(); ++n)
    archive.attribute(rate_name(group, n), parameters_.supplies[n].rate);
  if (state.returning.empty()) return;
  // The first rank writes all that return, body by body.
  const std::string returning = group + "/returning";
  GrainBatch batch;
  std::vector<ClumpRow> clumps;
  std::vector<double> due;
  std::vector<std::int64_t> sink;
  for (const ReturningBody& back : state.returning) {
    batch.rows.insert(batch.rows.end(), back.body.rows.begin(), back.body.rows.end());
    if (back.body.clump) clumps.push_back(*back.body.clump);
    due.push_back(back.due);
    sink.push_back(static_cast<std::int64_t>(back.sink));
  }
  const auto all_on_first = [this](std::size_t rows) {
    RowRange share(static_cast<std::int64_t>(rows), 1, 0);
    if (rank_of(communicator_) != 0) share.last = 0;
    return share;
  };
  const auto written = [this](auto& values) {
    if (rank_of(communicator_) != 0) values.clear();
  };
  const RowRange rows = all_on_first(batch.rows.size()), clump_rows = all_on_first(clumps.size());
  const bool with_clumps = !clumps.empty();
  written(batch.rows);
  written(clumps);
  write_grains(archive, returning, batch, rows, 0, true, with_clumps);
  if (with_clumps) write_clumps(archive, returning, std::move(clumps), clump_rows);
  write_whole(archive, communicator_, returning + "/due", due);
  write_whole(archive, communicator_, returning + "/sink", sink);
}

namespace {

// The bodies that were on their way back, as save_turnover() writes them.
std::vector<ReturningBody> load_returning(ArchiveReader& archive, const std::string& group) {
  if (!has_all_or_none(archive, {group + "/radius", group + "/due", group + "/sink"})) return {};
  const auto count_of = [&](const char* name) { return static_cast<std::int64_t>(archive.shape(group + name).at(0)); };
  const auto bodies = static_cast<std::size_t>(count_of("/due"));
  const auto due = read_whole<double>(archive, group + "/due", {bodies});
  const auto sink = read_whole<std::int64_t>(archive, group + "/sink", {bodies});
  const GrainBatch batch = read_grains(archive, group, RowRange(count_of("/radius"), 1, 0), 0);
  std::vector<ClumpRow> clumps;
  if (archive.has(group + "/clump_id")) clumps = read_clumps(archive, group, RowRange(count_of("/clump_id"), 1, 0));
  std::vector<ReturningBody> returning;
  for (const GrainRow& row : batch.rows) {
    if (row.clump < 0 || row.id == row.clump) {
      const std::size_t n = returning.size();
      if (n == bodies) throw damaged_dataset(group + "/due", fmt::format("the file holds {} of more grains", bodies));
      returning.push_back({{}, static_cast<std::size_t>(sink[n]), due[n]});
      const auto clump = std::find_if(clumps.begin(), clumps.end(), [&](const ClumpRow& c) { return c.id == row.id; });
      if (row.clump >= 0 && clump == clumps.end())
        throw damaged_dataset(group + "/clump_id", fmt::format("the file holds no clump {}", row.clump));
      if (row.clump >= 0) returning.back().body.clump = *clump;
    }
    if (returning.empty())
      throw damaged_dataset(group + "/radius", fmt::format("clump {} begins with its second sphere", row.clump));
    returning.back().body.rows.push_back(row);
  }
  if (returning.size() < bodies)
    throw damaged_dataset(group + "/radius", fmt::format("the file holds {} of {} grains", returning.size(), bodies));
  return returning;
}

}  // namespace

// What is due is counted from the start of the run, so that another rate would bring a burst or a pause.
static void check_rates(ArchiveReader& archive, const std::string& group, const std::vector<Supply>& supplies) {
  for (std::size_t n = 0; n < supplies.size(); ++n) {
    const std::string name = rate_name(group, n);
    if (!archive.has(name)) continue;  // older checkpoints have none
    const double saved = archive.real_attribute(name), now = supplies[n].rate;
    if (!same_but_for_rounding(saved, now))
      throw InputError(fmt::format(
          "Supply {0} brings {1:.4g} {3} now, and has brought {2:.4g} {3} so far. A transport rate depends on the "
          "reference grain, the density of the fluid and gravity; set these back, or begin a new run.",
          n, now, saved, supplies[n].by_mass ? "kg/s" : "grains/s"));
  }
}

void GrainDynamics::load_turnover(ArchiveReader& archive, const std::string& group) {
  if (!turnover_.any() || !archive.has(group + "/first_supplied_id")) return;
  turnover_.set_first_id(archive.integer_attribute(group + "/first_supplied_id"));
  turnover_.set_largest(archive.real_attribute(group + "/largest_radius"),
                        archive.real_attribute(group + "/largest_offset"));
  Turnover::State state = turnover_.state();
  for (const auto& [name, tallies] : {std::pair{"supply", &state.supplied}, std::pair{"sink", &state.taken}})
    for (std::size_t n = 0; n < tallies->size(); ++n) {
      (*tallies)[n].bodies = archive.integer_attribute(fmt::format("{}/{}_{}_bodies", group, name, n));
      (*tallies)[n].mass = archive.real_attribute(fmt::format("{}/{}_{}_mass", group, name, n));
    }
  check_rates(archive, group, parameters_.supplies);
  state.returning = load_returning(archive, group + "/returning");
  turnover_.set_state(std::move(state));
}

}  // namespace thalweg::dem
