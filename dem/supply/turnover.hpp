// The book of what comes into the box and leaves it: which bodies are due, how many have come and gone, and those that
// are on their way from a sink back to their entrance. Every rank keeps the same book.
//
// Ids: the grains of the start have those below first_id(). Each round of supplies takes as many ids as their bodies
// have members together; body n of supply s has those from first_id() + n stride + (members of the supplies before s).
// So an id says which supply it is from, is never given twice, and is the same on any number of ranks. A body that
// recirculates keeps its ids.
#pragma once

#include "core/geometry/periodic_box.hpp"
#include "core/state/system.hpp"
#include "dem/supply/free_places.hpp"
#include "dem/supply/supply.hpp"
#include "dem/supply/travelling_body.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::dem {

// Bodies and their mass.
struct Tally {
  std::int64_t bodies = 0;
  double mass = 0.0;  // kg
  void add(double more) { ++bodies, mass += more; }
};

// A body on its way back.
struct ReturningBody {
  TravellingBody body;
  std::size_t sink;
  double due = 0.0;  // s
};

// Throws InputError for a rate that is not positive, a zone outside the box or impossible heights above the bed.
void check(std::span<const Supply> supplies, std::span<const Sink> sinks, const PeriodicBox& box);

class Turnover {
public:
  Turnover(std::vector<Supply> supplies, std::vector<Sink> sinks, const PeriodicBox& box);

  bool any() const { return !supplies_.empty() || !sinks_.empty(); }
  const std::vector<Supply>& supplies() const { return supplies_; }
  const std::vector<Sink>& sinks() const { return sinks_; }

  GlobalId first_id() const { return first_id_; }
  void set_first_id(GlobalId id) { first_id_ = id; }
  GlobalId id_limit() const;  // no id is as large

  // The largest radius, and distance of a member from its clump's centre, of any grain that has been here (m): those
  // that come in are no larger. Zero until it is set.
  double largest_radius() const { return largest_radius_; }
  double largest_offset() const { return largest_offset_; }
  void set_largest(double radius, double offset) { largest_radius_ = radius, largest_offset_ = offset; }

  // Number of the sink that a point (m) is in, the lowest of several; -1: none.
  int sink_at(const Vec3& point) const;

  // The bodies that are due at a time (s), the first of them if there are many.
  std::vector<PlaceSeeker> due(double time) const;
  // Enters in the book which of them have come in.
  void enter(std::span<const PlaceSeeker> seekers, const std::vector<std::optional<FreePlace>>& places);
  // Enters a body that has left by a sink at a time (s).
  void leave(TravellingBody body, std::size_t sink, double time);

  // supplied_grains (1), supplied_mass (kg), left_grains, left_mass: since the start, a clump being one grain;
  // supply_lag (s): how long the body that has waited longest for a place has done so. With a recirculation also
  // recirculated_grains, recirculated_mass, and returning_grains (1), those on their way.
  std::vector<Diagnostic> diagnostics(double time) const;

  // State, for a checkpoint: what each supply has brought, what each sink has taken, who returns.
  struct State {
    std::vector<Tally> supplied, taken;
    std::vector<ReturningBody> returning;
  };
  const State& state() const { return state_; }
  void set_state(State state) { state_ = std::move(state); }

private:
  TravellingBody body_of(std::size_t supply, std::int64_t number) const;
  bool is_due(const Supply& supply, const Tally& so_far, double mass, double time) const;
  double due_time(const Supply& supply, const Tally& so_far, double mass) const;
  bool recirculates() const;

  std::vector<Supply> supplies_;
  std::vector<Sink> sinks_;
  PeriodicBox box_;
  GlobalId first_id_ = 0, stride_ = 0;
  double largest_radius_ = 0.0, largest_offset_ = 0.0;
  State state_;
};

}  // namespace thalweg::dem
