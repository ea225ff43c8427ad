#include "dem/supply/turnover.hpp"

#include "core/base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace thalweg::dem {

namespace {

constexpr std::size_t most_at_once = 64;  // bodies that seek a place in one step, of all supplies, and of all sinks
constexpr double rounding = 1e-9;         // of a count or mass that is due

void check_zone(const Zone& zone, const PeriodicBox& box, const std::string& what) {
  if (!zone.is_in(box.size))
    throw InputError(
        fmt::format("The zone of {} does not lie in the box with its lower corner below the upper one.", what));
}

void check_height(const Entrance& entrance, const PeriodicBox& box, const std::string& what) {
  if (!entrance.above_bed) return;
  const auto [lower, upper] = *entrance.above_bed;
  if (!(lower >= 0.0 && lower <= upper))
    throw InputError(fmt::format(
        "The heights of {} above the bed are {:g} and {:g} m; neither may be negative, nor the lower above the upper.",
        what, lower, upper));
  if (box.periodic[2])
    throw InputError(fmt::format("There is no bed for {} to be above: the box is periodic upwards.", what));
}

// Bodies of each of so many supplies or sinks: an equal share, so that none has to wait for another.
std::size_t share_of_each(std::size_t count) { return most_at_once / std::max<std::size_t>(1, count) + 1; }

// The height (m) at which a body left the box, if its entrance has that height, too.
std::optional<double> height_within(const Zone& zone, const TravellingBody& body) {
  const double height = body.centre().z();
  if (height < zone.lower.z() || height > zone.upper.z()) return std::nullopt;
  return height;
}

}  // namespace

void check(std::span<const Supply> supplies, std::span<const Sink> sinks, const PeriodicBox& box) {
  for (std::size_t s = 0; s < supplies.size(); ++s) {
    const std::string what = fmt::format("supply {}", s);
    if (!(supplies[s].rate > 0.0))
      throw InputError(fmt::format("The rate of {} is {:g}; it must be positive.", what, supplies[s].rate));
    check_zone(supplies[s].entrance.zone, box, what);
    check_height(supplies[s].entrance, box, what);
  }
  for (std::size_t s = 0; s < sinks.size(); ++s) {
    check_zone(sinks[s].zone, box, fmt::format("sink {}", s));
    if (const auto& back = sinks[s].recirculation) check_zone(back->entrance.zone, box, fmt::format("sink {}", s));
  }
}

Turnover::Turnover(std::vector<Supply> supplies, std::vector<Sink> sinks, const PeriodicBox& box)
    : supplies_(std::move(supplies)), sinks_(std::move(sinks)), box_(box) {
  check(supplies_, sinks_, box_);
  state_.supplied.resize(supplies_.size());
  state_.taken.resize(sinks_.size());
  for (const Supply& supply : supplies_) stride_ += supply.members;
}

GlobalId Turnover::id_limit() const {
  std::int64_t rounds = 0;
  for (const Tally& supplied : state_.supplied) rounds = std::max(rounds, supplied.bodies);
  return first_id_ + rounds * stride_;
}

int Turnover::sink_at(const Vec3& point) const {
  for (std::size_t s = 0; s < sinks_.size(); ++s)
    if (sinks_[s].zone.holds(point)) return static_cast<int>(s);
  return -1;
}

TravellingBody Turnover::body_of(std::size_t supply, std::int64_t number) const {
  TravellingBody body = std::move(bodies_of(supplies_[supply].make(number), box_).front());
  GlobalId id = first_id_ + number * stride_;
  for (std::size_t s = 0; s < supply; ++s) id += supplies_[s].members;
  body.renumber(id);
  return body;
}

// The time (s) from which the body after those so far is due.
double Turnover::due_time(const Supply& supply, const Tally& so_far, double mass) const {
  const double amount = supply.by_mass ? so_far.mass + mass : static_cast<double>(so_far.bodies + 1);
  return supply.from + amount * (1.0 - rounding) / supply.rate;
}

bool Turnover::is_due(const Supply& supply, const Tally& so_far, double mass, double time) const {
  return due_time(supply, so_far, mass) <= std::min(time, supply.until);
}

std::vector<PlaceSeeker> Turnover::due(double time) const {
  std::vector<PlaceSeeker> seekers;
  int queue = 0;
  std::vector<std::size_t> of_sink(sinks_.size(), 0);
  for (const ReturningBody& back : state_.returning) {
    if (back.due > time || of_sink[back.sink] == share_of_each(sinks_.size())) continue;
    ++of_sink[back.sink];
    const Entrance& entrance = sinks_[back.sink].recirculation->entrance;
    seekers.push_back({back.body, &entrance, height_within(entrance.zone, back.body), queue++});
  }
  for (std::size_t s = 0; s < supplies_.size(); ++s, ++queue) {
    Tally so_far = state_.supplied[s];
    for (std::size_t n = 0; n < share_of_each(supplies_.size()); ++n) {
      TravellingBody next = body_of(s, so_far.bodies);
      if (!is_due(supplies_[s], so_far, next.mass(), time)) break;
      so_far.add(next.mass());
      seekers.push_back({std::move(next), &supplies_[s].entrance, std::nullopt, queue});
    }
  }
  return seekers;
}

void Turnover::enter(std::span<const PlaceSeeker> seekers, const std::vector<std::optional<FreePlace>>& places) {
  for (std::size_t n = 0; n < seekers.size(); ++n) {
    if (!places[n]) continue;
    const Entrance* entrance = seekers[n].entrance;
    for (std::size_t s = 0; s < supplies_.size(); ++s)
      if (entrance == &supplies_[s].entrance) state_.supplied[s].add(seekers[n].body.mass());
    std::erase_if(state_.returning,
                  [id = seekers[n].body.id()](const ReturningBody& back) { return back.body.id() == id; });
  }
}

void Turnover::leave(TravellingBody body, std::size_t sink, double time) {
  state_.taken[sink].add(body.mass());
  if (const auto& back = sinks_[sink].recirculation)
    state_.returning.push_back({std::move(body), sink, time + back->delay});
}

bool Turnover::recirculates() const {
  return std::any_of(sinks_.begin(), sinks_.end(), [](const Sink& sink) { return sink.recirculation.has_value(); });
}

std::vector<Diagnostic> Turnover::diagnostics(double time) const {
  Tally supplied, left, recirculated;
  double lag = 0.0;
  for (std::size_t s = 0; s < supplies_.size(); ++s) {
    const Tally& so_far = state_.supplied[s];
    supplied.bodies += so_far.bodies, supplied.mass += so_far.mass;
    const double mass = body_of(s, so_far.bodies).mass();
    if (is_due(supplies_[s], so_far, mass, time)) lag = std::max(lag, time - due_time(supplies_[s], so_far, mass));
  }
  for (std::size_t s = 0; s < sinks_.size(); ++s) {
    Tally& sum = sinks_[s].recirculation ? recirculated : left;
    sum.bodies += state_.taken[s].bodies, sum.mass += state_.taken[s].mass;
  }
  for (const ReturningBody& back : state_.returning) lag = std::max(lag, time - back.due);
  std::vector<Diagnostic> diagnostics{{"supplied_grains", "1", static_cast<double>(supplied.bodies)},
                                      {"supplied_mass", "kg", supplied.mass},
                                      {"left_grains", "1", static_cast<double>(left.bodies)},
                                      {"left_mass", "kg", left.mass},
                                      {"supply_lag", "s", lag}};
  if (!recirculates()) return diagnostics;
  diagnostics.push_back({"recirculated_grains", "1", static_cast<double>(recirculated.bodies)});
  diagnostics.push_back({"recirculated_mass", "kg", recirculated.mass});
  diagnostics.push_back({"returning_grains", "1", static_cast<double>(state_.returning.size())});
  return diagnostics;
}

}  // namespace thalweg::dem
