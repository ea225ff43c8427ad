#include "dem/supply/free_places.hpp"

#include "core/base/counter_random.hpp"
#include "core/parallel/mpi_count.hpp"
#include "dem/contact/solid_contacts.hpp"

#include <algorithm>

namespace thalweg::dem {

namespace {

using Mask = std::uint32_t;
static_assert(places_tried <= 32);

bool tries_own_height(const PlaceSeeker& seeker, int attempt) { return seeker.height && attempt < places_tried / 2; }

Vec3 place_tried(const PlaceSeeker& seeker, std::uint64_t draw, int attempt) {
  const Zone& zone = seeker.entrance->zone;
  Vec3 place;
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint64_t number =
        3 * (draw * places_tried + static_cast<std::uint64_t>(attempt)) + static_cast<std::uint64_t>(axis);
    const double share = uniform_random(static_cast<std::uint64_t>(seeker.entrance->seed),
                                        static_cast<std::uint64_t>(seeker.body.id()), number);
    place[axis] = zone.lower[axis] + share * (zone.upper[axis] - zone.lower[axis]);
  }
  if (tries_own_height(seeker, attempt)) place.z() = *seeker.height;
  return place;
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

bool meets_walls(const TravellingBody& body, const Vec3& place, const PlaceSurroundings& around) {
  for (std::size_t r = 0; r < body.rows.size(); ++r) {
    const Vec3 centre = around.box.wrapped(place + body.arm(r));
    const double radius = body.rows[r].radius;
    for (const Plane& wall : around.walls)
      if (wall.seen_from(centre, around.box).distance < radius) return true;
    if (!around.solids.empty() &&
        depth_in_solids(centre, radius, around.box, around.placed_solids, around.solids).depth > 0.0)
      return true;
  }
  return false;
}

// The grains of this rank that a body could touch anywhere in its entrance.
std::vector<std::size_t> grains_near(const PlaceSeeker& seeker, const GrainStore& store, std::span<const char> leaving,
                                     const PeriodicBox& box) {
  const Zone& zone = seeker.entrance->zone;
  const Vec3 middle = 0.5 * (zone.lower + zone.upper), half = 0.5 * (zone.upper - zone.lower);
  const double reach = seeker.body.reach();
  std::vector<std::size_t> near;
  for (std::size_t s = 0; s < store.owned; ++s) {
    if (leaving[s] != 0) continue;
    const Vec3 off = box.difference(store.position[s], middle).cwiseAbs() - half;
    if ((off.array() < reach + store.radius[s]).all()) near.push_back(s);
  }
  return near;
}

// The places at which a body cannot be: those that grains of this rank, walls or solids block.
Mask blocked_places(const PlaceSeeker& seeker, const GrainStore& store, std::span<const char> leaving,
                    const PlaceSurroundings& around, std::uint64_t draw) {
  const std::vector<std::size_t> near = grains_near(seeker, store, leaving, around.box);
  Mask blocked = 0;
  for (int attempt = 0; attempt < places_tried; ++attempt) {
    const Vec3 place = place_tried(seeker, draw, attempt);
    const bool by_grain = std::any_of(near.begin(), near.end(), [&](std::size_t s) {
      return overlaps(seeker.body, place, store.position[s], store.radius[s], around.box);
    });
    if (by_grain || meets_walls(seeker.body, place, around)) blocked |= Mask{1} << attempt;
  }
  return blocked;
}

}  // namespace

std::vector<std::optional<FreePlace>> free_places(std::span<const PlaceSeeker> seekers, const GrainStore& store,
                                                  std::span<const char> leaving, const PlaceSurroundings& surroundings,
                                                  std::uint64_t draw, MPI_Comm communicator) {
  std::vector<Mask> blocked;
  for (const PlaceSeeker& seeker : seekers)
    blocked.push_back(blocked_places(seeker, store, leaving, surroundings, draw));
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
      const Vec3 place = place_tried(seekers[n], draw, attempt);
      if ((blocked[n] >> attempt & 1u) == 0 && !meets_earlier(n, place))
        places[n] = FreePlace{place, tries_own_height(seekers[n], attempt)};
    }
    if (!places[n]) stopped.push_back(seekers[n].queue);
  }
  return places;
}

}  // namespace thalweg::dem
