#include "dem/supply/free_places.hpp"

#include "core/base/counter_random.hpp"
#include "core/parallel/mpi_count.hpp"
#include "dem/contact/solid_contacts.hpp"
#include "dem/supply/bed_level.hpp"

#include <algorithm>
#include <array>

namespace thalweg::dem {

namespace {

using Mask = std::uint32_t;
static_assert(places_tried <= 32);

// The places that a body tries; none: above the bed there is no room for one in the entrance.
using Trials = std::array<std::optional<Vec3>, places_tried>;

bool tries_own_height(const PlaceSeeker& seeker, int attempt) { return seeker.height && attempt < places_tried / 2; }

// A random point of the unit cube.
Vec3 drawn(const PlaceSeeker& seeker, std::uint64_t draw, int attempt) {
  Vec3 shares;
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint64_t number =
        3 * (draw * places_tried + static_cast<std::uint64_t>(attempt)) + static_cast<std::uint64_t>(axis);
    shares[axis] = uniform_random(static_cast<std::uint64_t>(seeker.entrance->seed),
                                  static_cast<std::uint64_t>(seeker.body.id()), number);
  }
  return shares;
}

Vec3 point_of(const Zone& zone, const Vec3& shares) {
  return zone.lower + Vec3(shares.array() * (zone.upper - zone.lower).array());
}

// The part of a column of the entrance that is above a bed of this level (m); none: there is no such part.
std::optional<Zone> above_bed(const Entrance& entrance, double level) {
  Zone zone = entrance.zone;
  zone.lower.z() = std::max(zone.lower.z(), level + entrance.above_bed->lower);
  zone.upper.z() = std::min(zone.upper.z(), level + entrance.above_bed->upper);
  if (zone.lower.z() > zone.upper.z()) return std::nullopt;
  return zone;
}

// Levels (m) of the bed under the places that bodies try, places_tried for each that comes in above it, in their order;
// those of all ranks. Collective where there is one.
std::vector<double> levels_under(std::span<const PlaceSeeker> seekers, const GrainsAround& grains,
                                 const Surroundings& around, std::uint64_t draw, MPI_Comm communicator) {
  std::vector<std::size_t> bed;
  for (std::size_t s = 0; s < grains.store.owned; ++s)
    if (grains.in_bed[s] != 0 && grains.leaving[s] == 0) bed.push_back(s);
  std::vector<double> levels;
  for (const PlaceSeeker& seeker : seekers) {
    if (!seeker.entrance->above_bed) continue;
    for (int attempt = 0; attempt < places_tried; ++attempt) {
      Vec3 top = point_of(seeker.entrance->zone, drawn(seeker, draw, attempt));
      top.z() = seeker.entrance->zone.upper.z();
      levels.push_back(std::max(level_of_surroundings(top, around),
                                level_of_grains(top, seeker.body.reach(), grains.store, bed, around.box)));
    }
  }
  if (!levels.empty())
    MPI_Allreduce(MPI_IN_PLACE, levels.data(), mpi_count(levels.size()), MPI_DOUBLE, MPI_MAX, communicator);
  return levels;
}

// The places that each body tries. Collective where one comes in above the bed.
std::vector<Trials> trials_of(std::span<const PlaceSeeker> seekers, const GrainsAround& grains,
                              const Surroundings& around, std::uint64_t draw, MPI_Comm communicator) {
  const std::vector<double> levels = levels_under(seekers, grains, around, draw, communicator);
  auto level = levels.begin();
  std::vector<Trials> trials(seekers.size());
  for (std::size_t n = 0; n < seekers.size(); ++n)
    for (int attempt = 0; attempt < places_tried; ++attempt) {
      const Entrance& entrance = *seekers[n].entrance;
      const std::optional<Zone> zone = entrance.above_bed ? above_bed(entrance, *level++) : entrance.zone;
      if (!zone) continue;
      Vec3 place = point_of(*zone, drawn(seekers[n], draw, attempt));
      if (tries_own_height(seekers[n], attempt)) place.z() = *seekers[n].height;
      trials[n][static_cast<std::size_t>(attempt)] = place;
    }
  return trials;
}

// True if a body at a place overlaps a sphere.
bool overlaps(const TravellingBody& body, const Vec3& place, const Vec3& centre, double radius,
              const PeriodicBox& box) {
  for (std::size_t r = 0; r < body.rows.size(); ++r) {
    const double apart = body.rows[r].radius + radius;
    if (box.difference(box.wrapped(place + body.arm(r)), centre).squaredNorm() < apart * apart) return true;
  }
  return false;
}

// Depth (m) of a body at a place in walls and solids; 0 where it is clear of them.
double depth_in_walls(const TravellingBody& body, const Vec3& place, const Surroundings& around) {
  double depth = 0.0;
  for (std::size_t r = 0; r < body.rows.size(); ++r) {
    const Vec3 centre = around.box.wrapped(place + body.arm(r));
    const double radius = body.rows[r].radius;
    for (const Plane& wall : around.walls)
      depth = std::max(depth, radius - wall.seen_from(centre, around.box).distance);
    if (!around.solids.empty())
      depth = std::max(depth, depth_in_solids(centre, radius, around.box, around.placed, around.solids).depth);
  }
  return depth;
}

// Depth (m) that a body may have in walls and solids at its own height: that of the place at which it left, so that
// what lies, rolls or slides on a floor goes on as it did. Where a wall has moved there since, it may have none.
double own_depth(const PlaceSeeker& seeker, const Surroundings& around) {
  constexpr double rounding = 1e-9, deepest = 0.01;  // of its reach
  if (!seeker.height) return 0.0;
  const double reach = seeker.body.reach(), depth = depth_in_walls(seeker.body, seeker.body.centre(), around);
  return depth > 0.0 && depth < deepest * reach ? depth + rounding * reach : 0.0;
}

// The grains of this rank that a body could touch anywhere in its entrance.
std::vector<std::size_t> grains_near(const PlaceSeeker& seeker, const GrainsAround& grains, const PeriodicBox& box) {
  const GrainStore& store = grains.store;
  const Zone& zone = seeker.entrance->zone;
  const Vec3 middle = 0.5 * (zone.lower + zone.upper), half = 0.5 * (zone.upper - zone.lower);
  const double reach = seeker.body.reach();
  std::vector<std::size_t> near;
  for (std::size_t s = 0; s < store.owned; ++s) {
    if (grains.leaving[s] != 0) continue;
    const Vec3 off = box.difference(store.position[s], middle).cwiseAbs() - half;
    if ((off.array() < reach + store.radius[s]).all()) near.push_back(s);
  }
  return near;
}

// The places at which a body cannot be: those that grains of this rank, walls or solids block, and those that are none.
Mask blocked_places(const PlaceSeeker& seeker, const Trials& trials, const GrainsAround& grains,
                    const Surroundings& around) {
  const GrainStore& store = grains.store;
  const std::vector<std::size_t> near = grains_near(seeker, grains, around.box);
  const double at_own_height = own_depth(seeker, around);
  Mask blocked = 0;
  for (std::size_t attempt = 0; attempt < places_tried; ++attempt) {
    const std::optional<Vec3>& place = trials[attempt];
    const auto by_grain = [&](std::size_t s) {
      return overlaps(seeker.body, *place, store.position[s], store.radius[s], around.box);
    };
    const double allowed = tries_own_height(seeker, static_cast<int>(attempt)) ? at_own_height : 0.0;
    if (!place || std::any_of(near.begin(), near.end(), by_grain) ||
        depth_in_walls(seeker.body, *place, around) > allowed)
      blocked |= Mask{1} << attempt;
  }
  return blocked;
}

}  // namespace

std::vector<std::optional<FreePlace>> free_places(std::span<const PlaceSeeker> seekers, const GrainsAround& grains,
                                                  const Surroundings& surroundings, std::uint64_t draw,
                                                  MPI_Comm communicator) {
  const std::vector<Trials> trials = trials_of(seekers, grains, surroundings, draw, communicator);
  std::vector<Mask> blocked;
  for (std::size_t n = 0; n < seekers.size(); ++n)
    blocked.push_back(blocked_places(seekers[n], trials[n], grains, surroundings));
  MPI_Allreduce(MPI_IN_PLACE, blocked.data(), mpi_count(blocked.size()), MPI_UINT32_T, MPI_BOR, communicator);

  std::vector<std::optional<FreePlace>> places(seekers.size());
  const auto meets_earlier = [&](std::size_t n, const Vec3& place) {
    for (std::size_t m = 0; m < n; ++m) {
      if (!places[m]) continue;
      const TravellingBody& other = seekers[m].body;
      for (std::size_t r = 0; r < other.rows.size(); ++r)
        if (overlaps(seekers[n].body, place, surroundings.box.wrapped(places[m]->centre + other.arm(r)),
                     other.rows[r].radius, surroundings.box))
          return true;
    }
    return false;
  };
  std::vector<int> stopped;  // queues whose next body waits
  for (std::size_t n = 0; n < seekers.size(); ++n) {
    if (std::find(stopped.begin(), stopped.end(), seekers[n].queue) != stopped.end()) continue;
    for (int attempt = 0; attempt < places_tried && !places[n]; ++attempt) {
      if ((blocked[n] >> attempt & 1u) != 0) continue;
      const Vec3& place = *trials[n][static_cast<std::size_t>(attempt)];
      if (!meets_earlier(n, place)) places[n] = FreePlace{place, tries_own_height(seekers[n], attempt)};
    }
    if (!places[n]) stopped.push_back(seekers[n].queue);
  }
  return places;
}

}  // namespace thalweg::dem
