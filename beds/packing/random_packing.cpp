#include "beds/packing/random_packing.hpp"

#include "beds/packing/sphere_cells.hpp"
#include "core/base/counter_random.hpp"
#include "core/base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace thalweg::beds {
namespace {

constexpr unsigned most_attempts = 5000;  // of one grain

// The place (m, wrapped) that a grain tries in an attempt, both numbered from 0 on. The region must have room for it.
Vec3 random_place(const PeriodicBox& box, const GrainsToPlace& grains, std::int64_t number, unsigned attempt) {
  const Region& region = grains.region;
  Vec3 place;
  for (unsigned axis = 0; axis < 3; ++axis) {
    if (region.plane && axis == 1) {
      place[1] = 0.5 * (region.lower[1] + region.upper[1]);
      continue;
    }
    const double margin = wraps(box, region, static_cast<int>(axis)) ? 0.0 : grains.radius(number) + grains.clearance;
    const double free = region.upper[axis] - region.lower[axis] - 2.0 * margin;
    place[axis] = region.lower[axis] + margin +
                  free * uniform_random(grains.seed, static_cast<std::uint64_t>(number), 3u * attempt + axis);
  }
  return box.wrapped(place);
}

// True if the largest grain fits between the faces of the region.
bool has_room_at_random(const PeriodicBox& box, const GrainsToPlace& grains) {
  for (int axis = 0; axis < 3; ++axis) {
    if (wraps(box, grains.region, axis) || (grains.region.plane && axis == 1)) continue;
    const double extent = grains.region.upper[axis] - grains.region.lower[axis];
    if (extent - 2.0 * (grains.largest_radius + grains.clearance) < 0.0) return false;
  }
  return true;
}

// beside_others: grains of other populations had their places before.
InputError too_many_at_random(const GrainsToPlace& grains, bool beside_others, std::int64_t placed) {
  const Vec3 extent = grains.region.upper - grains.region.lower;
  return InputError(fmt::format(
      "{} grains do not fit at random in {:g} x {:g} x {:g} m{}: {} did; use fewer or smaller grains, a larger region, "
      "or another placement.pattern (dense or uniform){}.",
      grains.count, extent.x(), extent.y(), extent.z(), beside_others ? " beside those of other populations" : "",
      placed, beside_others ? ", or give the other populations less room" : ""));
}

// Place that a grain tries or has been given.
struct Trial {
  std::int64_t number;
  double radius, position[3];  // m, wrapped
  bool fits;                   // it has been given the place

  dem::PlacedSphere sphere() const { return {Vec3(position), radius}; }
};

// Trials after which to check whether grains still find places.
constexpr std::int64_t trials_between_checks = 100'000;

class SequentialAddition {
public:
  SequentialAddition(const PackingDomain& ranks, const GrainsToPlace& grains, std::span<const Obstacle> obstacles,
                     double largest_radius)
      : ranks_(ranks), grains_(grains), largest_(largest_radius), placed_cells_(ranks.box(), largest_radius) {
    for (const Obstacle& obstacle : obstacles)
      placed_cells_.add({ranks.box().wrapped(obstacle.sphere.position), obstacle.sphere.radius});
  }

  // Places the grains from this radius (m) up to another; true if all found a place.
  bool place(double from, double below) {
    std::vector<Trial> trials = first_trials(from, below);
    tried_ = fitted_ = 0;
    auto waiting = ranks_.sum(static_cast<std::int64_t>(trials.size()));
    if (waiting == 0) return true;
    for (unsigned attempt = 0; waiting > 0; ++attempt) {
      if (attempt == most_attempts || hopeless()) return false;
      trials = round(ranks_.to_knowing(trials), attempt);
      const std::int64_t fitted = ranks_.sum(std::count_if(trials.begin(), trials.end(), &has_place));
      tried_ += waiting;
      fitted_ += fitted;
      placed_by_all_ += fitted;
      waiting -= fitted;
    }
    for (const Trial& trial : ranks_.to_knowing(trials)) take(trial);
    return true;
  }

  // Placed grains that this rank knows, in order.
  std::vector<PlacedGrain> placed() {
    std::sort(placed_.begin(), placed_.end());
    return std::move(placed_);
  }

  std::int64_t placed_by_all() const { return placed_by_all_; }

private:
  std::vector<Trial> first_trials(double from, double below) const {
    std::vector<Trial> trials;
    const RowRange share = ranks_.share_of(grains_.count);
    for (std::int64_t number = share.first; number < share.last; ++number)
      if (const double radius = grains_.radius(number); radius >= from && radius < below)
        trials.push_back(trial(number, radius, 0));
    return trials;
  }

  static bool has_place(const Trial& trial) { return trial.fits; }

  Trial trial(std::int64_t number, double radius, unsigned attempt) const {
    Trial made{number, radius, {}, false};
    Vec3::Map(made.position) = random_place(ranks_.box(), grains_, number, attempt);
    return made;
  }

  // Records the places that were given, and decides the trials in this rank's block. Returns these: given places, and
  // the next trials.
  std::vector<Trial> round(const std::vector<Trial>& known, unsigned attempt) {
    SphereCells trying(ranks_.box(), largest_);
    for (const Trial& trial : known) {
      if (trial.fits)
        take(trial);
      else
        trying.add(trial.sphere(), trial.number);
    }
    std::vector<Trial> next;
    for (const Trial& tried : known) {
      if (tried.fits || !ranks_.owns(Vec3(tried.position))) continue;
      const auto goes_first = [&](std::int64_t other) { return other < tried.number; };
      const bool fits = !placed_cells_.overlaps(tried.sphere()) && !trying.overlaps(tried.sphere(), goes_first) &&
                        !ranks_.blocked(Vec3(tried.position), tried.radius);
      next.push_back(fits ? tried : trial(tried.number, tried.radius, attempt + 1));
      next.back().fits = fits;
    }
    return next;
  }

  void take(const Trial& trial) {
    placed_cells_.add(trial.sphere());
    placed_.push_back({trial.number, Vec3(trial.position)});
  }

  // True if so few of the last trials fitted that a grain has no fair chance of a place.
  bool hopeless() {
    if (tried_ < trials_between_checks) return false;
    const bool too_few = fitted_ * most_attempts < tried_;
    tried_ = fitted_ = 0;
    return too_few;
  }

  const PackingDomain& ranks_;
  const GrainsToPlace& grains_;
  double largest_;  // m, radius
  SphereCells placed_cells_;
  std::vector<PlacedGrain> placed_;
  std::int64_t placed_by_all_ = 0;
  std::int64_t tried_ = 0, fitted_ = 0;  // by all ranks, since the last check
};

}  // namespace

std::vector<PlacedGrain> random_packing(const PackingDomain& ranks, const GrainsToPlace& grains,
                                        std::span<const Obstacle> obstacles) {
  check_region(ranks.box(), grains.region);
  if (grains.count == 0) return {};
  double largest = grains.largest_radius, smallest = grains.largest_radius;
  for (const Obstacle& obstacle : obstacles) largest = std::max(largest, obstacle.sphere.radius);
  const RowRange share = ranks.share_of(grains.count);
  for (auto number = share.first; number < share.last; ++number) smallest = std::min(smallest, grains.radius(number));
  smallest = ranks.smallest(smallest);
  SequentialAddition placing(ranks, grains, obstacles, ranks.largest(largest));
  bool all = has_room_at_random(ranks.box(), grains);
  constexpr double next_size = 0.95;
  for (double below = std::numeric_limits<double>::infinity(), from = next_size * grains.largest_radius; all;
       below = std::exchange(from, next_size * from)) {
    all = placing.place(from, below);
    if (from <= smallest) break;
  }
  if (!all)
    throw too_many_at_random(grains, ranks.sum(static_cast<std::int64_t>(obstacles.size())) > 0,
                             placing.placed_by_all());
  return placing.placed();
}

namespace {

// Centres (m) of a parallel packing in one process.
std::vector<Vec3> packed_alone(const auto& packing, const PeriodicBox& box, const Region& region,
                               std::span<const double> radii, double clearance, std::uint64_t seed,
                               std::span<const dem::PlacedSphere> obstacles) {
  if (radii.empty()) return {};
  std::vector<Obstacle> numbered;
  for (const dem::PlacedSphere& sphere : obstacles)
    numbered.push_back({sphere, static_cast<std::int64_t>(numbered.size())});
  const GrainsToPlace grains{region,
                             static_cast<std::int64_t>(radii.size()),
                             [radii](std::int64_t number) { return radii[static_cast<std::size_t>(number)]; },
                             *std::max_element(radii.begin(), radii.end()),
                             clearance,
                             seed};
  std::vector<Vec3> centres;
  for (const PlacedGrain& grain : packing(PackingDomain(box), grains, numbered)) centres.push_back(grain.centre);
  return centres;
}

}  // namespace

std::vector<Vec3> random_packing(const PeriodicBox& box, const Region& region, std::span<const double> radii,
                                 double clearance, std::uint64_t seed, std::span<const dem::PlacedSphere> obstacles) {
  const auto packing = [](const auto&... of) { return random_packing(of...); };
  return packed_alone(packing, box, region, radii, clearance, seed, obstacles);
}

std::vector<Vec3> dense_packing(const PeriodicBox& box, const Region& region, std::span<const double> radii,
                                double clearance, std::uint64_t seed, std::span<const dem::PlacedSphere> obstacles) {
  const auto packing = [](const auto&... of) { return dense_packing(of...); };
  return packed_alone(packing, box, region, radii, clearance, seed, obstacles);
}

}  // namespace thalweg::beds
