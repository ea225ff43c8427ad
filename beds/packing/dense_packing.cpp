// The dense packing of random_packing.hpp: grains that start anywhere push each other apart until none overlap. A rank
// moves the grains that were in its block when the list of pairs was made, and has copies of those near them.
#include "beds/packing/random_packing.hpp"
#include "core/base/counter_random.hpp"
#include "core/base/error.hpp"
#include "dem/motion/cell_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace thalweg::beds {

namespace {

constexpr double growth = 1.001;  // of the radii, so that the true ones do not overlap in the end
constexpr double step = 0.2;      // of the way that would separate a pair; more makes crowded grains oscillate
constexpr double momentum = 0.9;  // share of the last move that is repeated
constexpr int most_iterations = 20000;

// A grain, or what it keeps clear of.
struct PackedBody {
  std::int64_t number;  // of obstacles those after the grains'
  double radius;        // m, grown
  double margin;        // m, of its centre to the region's faces that are not periodic
  double position[3];   // m
  double move[3];       // m, the last one
};

Eigen::Map<Vec3> location_of(PackedBody& body) { return Vec3::Map(body.position); }

bool has_lower_number(const PackedBody& a, const PackedBody& b) { return a.number < b.number; }

class Relaxation {
public:
  Relaxation(const PackingDomain& ranks, const GrainsToPlace& grains, std::span<const Obstacle> obstacles)
      : ranks_(ranks),
        box_(ranks.box()),
        grains_(grains),
        largest_(grains.largest_radius),
        lower_(grains.region.lower),
        upper_(grains.region.upper) {
    for (int axis = 0; axis < 3; ++axis) wraps_[axis] = wraps(box_, grains.region, axis);
    if (grains.region.plane) {
      wraps_[1] = false;
      lower_[1] = upper_[1] = 0.5 * (grains.region.lower[1] + grains.region.upper[1]);
    }
    for (int axis = 0; axis < 3; ++axis) keeps_away_[axis] = !wraps_[axis] && !(grains.region.plane && axis == 1);
    for (const Obstacle& obstacle : obstacles) {
      const Vec3 place = box_.wrapped(obstacle.sphere.position);
      const double radius = growth * obstacle.sphere.radius;
      largest_ = std::max(largest_, obstacle.sphere.radius);
      if (ranks.owns(place))
        obstacles_.push_back({grains.count + obstacle.number, radius, 0.0, {place.x(), place.y(), place.z()}, {}});
    }
    largest_ = growth * ranks.largest(largest_);
    spread_obstacles();
  }

  bool has_room() const {
    const Vec3 margin = (grains_.largest_radius + grains_.clearance) * keeps_away_;
    return ((upper_ - margin).array() >= (lower_ + margin).array()).all();
  }

  void scatter() {
    const RowRange share = ranks_.share_of(grains_.count);
    for (std::int64_t number = share.first; number < share.last; ++number) {
      const double radius = grains_.radius(number);
      PackedBody body{number, growth * radius, radius + grains_.clearance, {}, {}};
      const Vec3 lower = lower_of(body), upper = upper_of(body);
      for (unsigned axis = 0; axis < 3; ++axis) {
        const double free = upper[axis] - lower[axis];
        body.position[axis] =
            lower[axis] + free * uniform_random(grains_.seed, static_cast<std::uint64_t>(number), axis);
      }
      bodies_.push_back(body);
    }
    own_ = bodies_.size();
  }

  // Pushes grains apart; true if none overlap after at most most_iterations.
  bool relax() {
    double moved = skin();
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      if (moved >= skin()) {
        find_pairs(reach());
        moved = 0.0;
      }
      if (ranks_.largest(push_apart()) < 1.0 - 1.0 / growth) return true;
      moved += ranks_.largest(advance());
      const std::vector<PackedBody> near = copies_.exchanged(bodies_);
      std::copy(near.begin(), near.end(), bodies_.begin() + static_cast<std::ptrdiff_t>(own_));
    }
    return false;
  }

  std::vector<PlacedGrain> placed() {
    bodies_.resize(own_);
    for (PackedBody& body : bodies_) location_of(body) = box_.wrapped(location_of(body));
    std::vector<PackedBody> known = ranks_.to_knowing(bodies_);
    std::sort(known.begin(), known.end(), has_lower_number);
    std::vector<PlacedGrain> placed;
    for (PackedBody& body : known) placed.push_back({body.number, location_of(body)});
    return placed;
  }

private:
  // Bounds of its centre: up to a face of the region, or anywhere along an axis that the region wraps.
  Vec3 lower_of(const PackedBody& body) const { return lower_ + body.margin * keeps_away_; }
  Vec3 upper_of(const PackedBody& body) const { return upper_ - body.margin * keeps_away_; }

  // m, that grains may move before pairs are found again, and the distance of the pairs that may touch until then.
  double skin() const { return 0.2 * largest_; }
  double reach() const { return 2.0 * (largest_ + skin()); }

  // Sends the obstacles to all ranks whose grains may come to touch them.
  void spread_obstacles() {
    const std::vector<PackedBody> near = Copies(ranks_, obstacles_, reach()).exchanged(obstacles_);
    obstacles_.insert(obstacles_.end(), near.begin(), near.end());
  }

  // Pairs of bodies up to this far apart (m), of which one is a grain of this rank; each pair has the lower number
  // first, and pairs come in the order of their numbers, which depends neither on the grid nor on the ranks.
  void find_pairs(double distance) {
    bodies_.resize(own_);
    for (PackedBody& body : bodies_) location_of(body) = box_.wrapped(location_of(body));
    bodies_ = ranks_.to_owners(std::move(bodies_));
    std::sort(bodies_.begin(), bodies_.end(), has_lower_number);
    own_ = bodies_.size();
    copies_ = Copies(ranks_, bodies_, distance);
    const std::vector<PackedBody> near = copies_.exchanged(bodies_);
    bodies_.insert(bodies_.end(), near.begin(), near.end());
    first_obstacle_ = bodies_.size();
    bodies_.insert(bodies_.end(), obstacles_.begin(), obstacles_.end());

    std::vector<Vec3> places;
    for (PackedBody& body : bodies_) places.push_back(location_of(body));
    pairs_.clear();
    const dem::CellGrid grid(box_, distance, places);
    grid.for_each_near_pair([&](std::uint32_t m, std::uint32_t n) {
      std::uint32_t a = grid.order()[m], b = grid.order()[n];
      if (std::min(a, b) >= own_) return;
      if (has_lower_number(bodies_[b], bodies_[a])) std::swap(a, b);
      if (box_.difference(places[a], places[b]).squaredNorm() < distance * distance) pairs_.emplace_back(a, b);
    });
    std::sort(pairs_.begin(), pairs_.end(), [&](const auto& p, const auto& q) {
      const auto first = [&](const auto& pair) { return bodies_[pair.first].number; };
      const auto second = [&](const auto& pair) { return bodies_[pair.second].number; };
      return first(p) != first(q) ? first(p) < first(q) : second(p) < second(q);
    });
  }

  // Adds half of every overlap to the moves of both grains, all of it where one is an obstacle. Returns the largest
  // overlap over the distance of the centres of grains that touch.
  double push_apart() {
    double largest = 0.0;
    for (std::size_t n = 0; n < own_; ++n) Vec3::Map(bodies_[n].move) *= momentum;
    for (const auto& [a, b] : pairs_) {
      PackedBody &one = bodies_[a], &other = bodies_[b];
      const Vec3 apart = box_.difference(location_of(one), location_of(other));
      const double distance = apart.norm(), touching = one.radius + other.radius;
      if (distance >= touching) continue;
      largest = std::max(largest, 1.0 - distance / touching);
      const Vec3 normal = distance > 0.0 ? Vec3(apart / distance) : Vec3::UnitX();
      const Vec3 way = step * (touching - distance) * normal;
      Vec3::Map(one.move) += (b < first_obstacle_ ? 0.5 : 1.0) * way;
      if (b < first_obstacle_) Vec3::Map(other.move) -= 0.5 * way;
    }
    return largest;
  }

  // Returns the longest move, m.
  double advance() {
    double longest = 0.0;
    for (std::size_t n = 0; n < own_; ++n) {
      PackedBody& body = bodies_[n];
      const Vec3 from = location_of(body), lower = lower_of(body), upper = upper_of(body);
      for (int axis = 0; axis < 3; ++axis) {
        const double wanted = from[axis] + body.move[axis];
        body.position[axis] = wraps_[axis] ? wanted : std::clamp(wanted, lower[axis], upper[axis]);
      }
      Vec3::Map(body.move) = location_of(body) - from;
      longest = std::max(longest, Vec3::Map(body.move).norm());
    }
    return longest;
  }

  // The bodies of this rank that others have copies of, because they are near grains of those ranks.
  class Copies {
  public:
    Copies() = default;
    // Copies of grains within this distance (m) of a block.
    Copies(const PackingDomain& ranks, const std::vector<PackedBody>& own, double distance) : ranks_(&ranks) {
      if (ranks.alone()) return;
      for (std::size_t n = 0; n < own.size(); ++n)
        for (const int rank : ranks.decomposition().ranks_reached(Vec3(own[n].position), distance))
          if (rank != ranks.number()) {
            sent_.push_back(n);
            homes_.push_back(rank);
          }
    }

    // Sends them as they are now; returns the copies for this rank, in the same order every time. Collective.
    std::vector<PackedBody> exchanged(const std::vector<PackedBody>& own) const {
      std::vector<PackedBody> rows;
      for (const std::size_t n : sent_) rows.push_back(own[n]);
      return ranks_->exchanged(std::move(rows), homes_);
    }

  private:
    const PackingDomain* ranks_ = nullptr;
    std::vector<std::size_t> sent_;  // numbers in the list of own grains
    std::vector<int> homes_;         // where to
  };

  const PackingDomain& ranks_;
  PeriodicBox box_;
  const GrainsToPlace& grains_;
  double largest_;      // m, radius, grown
  Vec3 lower_, upper_;  // m, of the region; of disks their plane
  std::array<bool, 3> wraps_{};
  Vec3 keeps_away_;                 // 1 along axes with faces to keep away from, else 0
  std::vector<PackedBody> bodies_;  // grains of this rank, copies of others, obstacles
  std::size_t own_ = 0, first_obstacle_ = 0;
  std::vector<PackedBody> obstacles_;
  Copies copies_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;
};

}  // namespace

std::vector<PlacedGrain> dense_packing(const PackingDomain& ranks, const GrainsToPlace& grains,
                                       std::span<const Obstacle> obstacles) {
  check_region(ranks.box(), grains.region);
  if (grains.count == 0) return {};
  Relaxation relaxation(ranks, grains, obstacles);
  if (relaxation.has_room()) {
    relaxation.scatter();
    if (relaxation.relax()) return relaxation.placed();
  }
  const Vec3 extent = grains.region.upper - grains.region.lower;
  throw InputError(
      fmt::format("{} grains do not fit at random in {:g} x {:g} x {:g} m, though they were pushed apart; use fewer or "
                  "smaller grains or a larger region.",
                  grains.count, extent.x(), extent.y(), extent.z()));
}

}  // namespace thalweg::beds
