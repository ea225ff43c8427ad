#include "analysis/reach/grain_book.hpp"

#include "core/parallel/mpi_session.hpp"
#include "core/state/whole_dataset.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::analysis {

namespace {

constexpr double from_the_start = -1.0;  // s, for Memory::since

}  // namespace

GrainBook::Page GrainBook::look(double time, const PeriodicBox& box, GlobalId end_of_ids,
                                const std::vector<Body>& bodies) {
  const bool first = !homes_;
  if (first) homes_.emplace(communicator_, end_of_ids);
  homes_->grow(end_of_ids);
  memory_.resize(homes_->size());
  double fastest = 0.0;
  std::vector<Sighting> sightings;
  for (const Body& body : bodies) {
    const Vec3 &x = body.position, &v = body.velocity;
    sightings.push_back({body.id, x.x(), x.y(), x.z(), v.x(), v.y(), v.z(), body.volume});
    fastest = std::max(fastest, v.norm());
  }
  fastest = max_over_ranks(communicator_, fastest);
  const double duration = time - last_time_;
  const Interval interval{time, duration, farthest_away(diameter_, std::max(fastest, last_speed_), duration), first,
                          box};

  Page page;
  std::vector<char> here(memory_.size(), 0);
  for (const Sighting& seen : homes_->bring_home(sightings)) {
    const std::size_t place = homes_->location_of(seen.id);
    follow(memory_[place], seen, interval, page);
    here[place] = 1;
  }
  for (std::size_t place = 0; place < memory_.size(); ++place) {
    if (here[place] != 0 || memory_[place].state == absent) continue;
    leave(memory_[place], time, page);
    memory_[place] = {};
  }
  last_time_ = time;
  last_speed_ = fastest;
  return page;
}

void GrainBook::follow(Memory& memory, const Sighting& seen, const Interval& interval, Page& page) const {
  const Look look{{seen.x, seen.y, seen.z}, {seen.v_x, seen.v_y, seen.v_z}};
  Memory now{absent, look, seen.volume, memory.since};
  now.state = look.velocity.squaredNorm() > moving_speed_ * moving_speed_ ? moving : at_rest;
  const std::int64_t bin = sections_.bin_of(seen.x);
  const std::optional<std::int64_t> boxes = memory.state == absent ? std::nullopt : boxes_gone(memory, now, interval);
  if (boxes) {
    const std::int64_t bin_before = sections_.bin_of(memory.latest.position.x());
    cross(bin_before, bin + *boxes * sections_.bins, seen.volume, page);
    if (memory.state == at_rest && now.state == moving)
      page.entries.push_back({Passage::entrained, bin_before, seen.volume});
    if (memory.state == moving && now.state == at_rest) page.entries.push_back({Passage::deposited, bin, seen.volume});
  } else if (interval.first) {
    now.since = from_the_start;
  } else {
    if (memory.state != absent) leave(memory, interval.time, page);
    page.entries.push_back({Passage::arrived, bin, seen.volume});
    now.since = interval.time;
  }
  memory = now;
}

std::optional<std::int64_t> GrainBook::boxes_gone(const Memory& before, const Memory& now,
                                                  const Interval& interval) const {
  const Way gone = way_between(before.latest, now.latest, interval.duration, interval.box);
  if (recirculation_ && gone.away > interval.farthest) return std::nullopt;
  return std::llround(gone.boxes.x());
}

// from, to: bins, the second of them beyond the box where a grain has gone round.
void GrainBook::cross(std::int64_t from, std::int64_t to, double volume, Page& page) const {
  const Passage passage = to > from ? Passage::downstream : Passage::upstream;
  for (std::int64_t k = std::min(from, to) + 1; k <= std::max(from, to); ++k)
    page.entries.push_back({passage, sections_.inside(k), volume});
}

void GrainBook::leave(const Memory& memory, double time, Page& page) const {
  page.entries.push_back({Passage::left, sections_.bin_of(memory.latest.position.x()), memory.volume});
  if (memory.since >= 0.0) page.stays.push_back(time - memory.since);
}

void GrainBook::save(ArchiveWriter& archive, const std::string& group) const {
  archive.attribute(group + "/looked_last", last_time_);
  archive.attribute(group + "/largest_speed", last_speed_);
  if (!homes_) return;
  std::vector<double> rows;
  for (const Memory& m : memory_)
    rows.insert(rows.end(),
                {static_cast<double>(m.state), m.latest.position.x(), m.latest.position.y(), m.latest.position.z(),
                 m.latest.velocity.x(), m.latest.velocity.y(), m.latest.velocity.z(), m.volume, m.since});
  homes_->write(archive, group + "/grains", std::move(rows), columns);
}

void GrainBook::load(ArchiveReader& archive, const std::string& group, std::int64_t bodies) {
  last_time_ = archive.real_attribute(group + "/looked_last");
  last_speed_ = archive.real_attribute(group + "/largest_speed");
  if (!archive.has(group + "/grains")) return;
  homes_ = DistributionById::of_rows(communicator_, archive, group + "/grains", bodies);
  memory_.assign(homes_->size(), {});
  const auto rows = homes_->read<double>(archive, group + "/grains", columns);
  bool damaged = false;
  for (std::size_t m = 0; m < memory_.size(); ++m) {
    const double* row = rows.data() + m * columns;
    const bool known = row[0] == 0.0 || row[0] == 1.0 || row[0] == 2.0;
    damaged |= !known || !std::all_of(row, row + columns, [](double value) { return std::isfinite(value); });
    memory_[m] = {known ? static_cast<State>(static_cast<int>(row[0])) : absent,
                  {{row[1], row[2], row[3]}, {row[4], row[5], row[6]}},
                  row[7],
                  row[8]};
  }
  if (any_rank(communicator_, damaged))
    throw damaged_dataset(group + "/grains", "the file holds values that no grain has");
}

}  // namespace thalweg::analysis
