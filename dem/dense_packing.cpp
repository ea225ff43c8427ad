// The dense packing of packing.hpp: grains that start anywhere push each other apart until none overlap.
#include "core/counter_random.hpp"
#include "core/error.hpp"
#include "dem/cell_grid.hpp"
#include "dem/packing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace thalweg::dem {

namespace {

constexpr double growth = 1.001;  // of the radii, so that what is left of overlaps is none in truth
constexpr double step = 0.2;      // of the way that would separate a pair; more makes crowded grains swing
constexpr double momentum = 0.9;  // of the last move that is made again
constexpr int most_iterations = 20000;

class Relaxation {
public:
  Relaxation(const PeriodicBox& box, const Region& region, std::span<const double> radii, double clearance,
             std::span<const Sphere> obstacles)
      : box_(box), count_(radii.size()) {
    for (int axis = 0; axis < 3; ++axis) wraps_[axis] = wraps(box, region, axis) && !(region.plane && axis == 1);
    for (const double radius : radii) {
      radius_.push_back(growth * radius);
      lower_.push_back(room(region, radius + clearance, region.lower, 1.0));
      upper_.push_back(room(region, radius + clearance, region.upper, -1.0));
    }
    position_.resize(count_);
    for (const Sphere& obstacle : obstacles) {
      position_.push_back(box.wrapped(obstacle.position));
      radius_.push_back(growth * obstacle.radius);
    }
    largest_ = *std::max_element(radius_.begin(), radius_.end());
    move_.assign(count_, Vec3::Zero());
  }

  bool has_room() const {
    for (std::size_t n = 0; n < count_; ++n)
      if ((upper_[n].array() < lower_[n].array()).any()) return false;
    return true;
  }

  void scatter(std::uint64_t seed) {
    for (std::size_t n = 0; n < count_; ++n)
      for (unsigned axis = 0; axis < 3; ++axis) {
        const double free = upper_[n][axis] - lower_[n][axis];
        position_[n][axis] = lower_[n][axis] + free * uniform_random(seed, n, axis);
      }
  }

  // Whether none overlap after so many iterations.
  bool relax() {
    const double skin = 0.2 * largest_;
    double moved = skin;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      if (moved >= skin) {
        find_pairs(2.0 * (largest_ + skin));
        moved = 0.0;
      }
      if (push_apart() < 1.0 - 1.0 / growth) return true;
      moved += advance();
    }
    return false;
  }

  std::vector<Vec3> centres() const {
    return {position_.begin(), position_.begin() + static_cast<std::ptrdiff_t>(count_)};
  }

private:
  // Where the centre of a grain may be: up to a face of the region, or anywhere along an axis that the region wraps.
  Vec3 room(const Region& region, double margin, const Vec3& face, double inwards) const {
    Vec3 limit = face;
    for (int axis = 0; axis < 3; ++axis) {
      if (region.plane && axis == 1)
        limit[1] = 0.5 * (region.lower[1] + region.upper[1]);
      else if (!wraps_[axis])
        limit[axis] += inwards * margin;
    }
    return limit;
  }

  void find_pairs(double distance) {
    for (std::size_t n = 0; n < count_; ++n) position_[n] = box_.wrapped(position_[n]);
    pairs_.clear();
    const CellGrid grid(box_, distance, position_);
    grid.for_each_near_pair([&](std::uint32_t m, std::uint32_t n) {
      const std::uint32_t a = std::min(grid.order()[m], grid.order()[n]),
                          b = std::max(grid.order()[m], grid.order()[n]);
      if (a < count_ && box_.difference(position_[a], position_[b]).squaredNorm() < distance * distance)
        pairs_.emplace_back(a, b);
    });
    std::sort(pairs_.begin(), pairs_.end());  // an order that does not depend on the grid
  }

  // Adds half of every overlap to the moves of both grains, all of it where one is an obstacle. Returns the largest
  // overlap over the distance of the centres of grains that touch.
  double push_apart() {
    double largest = 0.0;
    for (Vec3& move : move_) move *= momentum;
    for (const auto& [a, b] : pairs_) {
      const Vec3 apart = box_.difference(position_[a], position_[b]);
      const double distance = apart.norm(), touching = radius_[a] + radius_[b];
      if (distance >= touching) continue;
      largest = std::max(largest, 1.0 - distance / touching);
      const Vec3 normal = distance > 0.0 ? Vec3(apart / distance) : Vec3::UnitX();
      const Vec3 way = step * (touching - distance) * normal;
      move_[a] += (b < count_ ? 0.5 : 1.0) * way;
      if (b < count_) move_[b] -= 0.5 * way;
    }
    return largest;
  }

  // Returns the longest move, m.
  double advance() {
    double longest = 0.0;
    for (std::size_t n = 0; n < count_; ++n) {
      const Vec3 before = position_[n];
      for (int axis = 0; axis < 3; ++axis) {
        const double wanted = before[axis] + move_[n][axis];
        position_[n][axis] = wraps_[axis] ? wanted : std::clamp(wanted, lower_[n][axis], upper_[n][axis]);
      }
      move_[n] = position_[n] - before;
      longest = std::max(longest, move_[n].norm());
    }
    return longest;
  }

  PeriodicBox box_;
  std::size_t count_;                  // of grains; obstacles follow
  std::vector<Vec3> position_, move_;  // m
  std::vector<double> radius_;         // m, grown
  std::vector<Vec3> lower_, upper_;    // m, of the centres of grains
  std::array<bool, 3> wraps_{};
  double largest_ = 0.0;  // m, radius
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;
};

}  // namespace

std::vector<Vec3> dense_packing(const PeriodicBox& box, const Region& region, std::span<const double> radii,
                                double clearance, std::uint64_t seed, std::span<const Sphere> obstacles) {
  check_region(box, region);
  if (radii.empty()) return {};
  Relaxation relaxation(box, region, radii, clearance, obstacles);
  if (relaxation.has_room()) {
    relaxation.scatter(seed);
    if (relaxation.relax()) {
      std::vector<Vec3> centres = relaxation.centres();
      for (Vec3& centre : centres) centre = box.wrapped(centre);
      return centres;
    }
  }
  throw InputError(
      fmt::format("{} grains do not fit at random in {:g} x {:g} x {:g} m, though they were pushed apart; use fewer or "
                  "smaller grains or a larger region.",
                  radii.size(), region.upper[0] - region.lower[0], region.upper[1] - region.lower[1],
                  region.upper[2] - region.lower[2]));
}

}  // namespace thalweg::dem
