// Places where bodies that come in touch nothing.
//
// Every rank draws the same random points for a body and says which of them its own grains block; among bodies that
// come in together the earlier has the place. So all ranks find the same places, on any number of ranks.
#pragma once

#include "core/base/types.hpp"
#include "dem/contact/neighbour_list.hpp"
#include "dem/motion/grain_store.hpp"
#include "dem/supply/supply.hpp"
#include "dem/supply/travelling_body.hpp"

#include <mpi.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace thalweg::dem {

// A body that seeks a place.
struct PlaceSeeker {
  TravellingBody body;
  const Entrance* entrance;
  std::optional<double> height;  // m, at which it tries first
  // Bodies in one queue come in one after the other: where one finds no place, those behind it wait, too.
  int queue;
};

// Points of its entrance that a body tries in one step; the first half of them are at its own height if it has one.
inline constexpr int places_tried = 16;

struct FreePlace {
  Vec3 centre;         // m
  bool at_own_height;  // that of the seeker
};

// The grains that a rank owns, and marks of their slots: 1 for those that leave, and that are part of the bed. The
// latter matter only where some entrance is above the bed.
struct GrainsAround {
  const GrainStore& store;
  std::span<const char> leaving, in_bed;
};

// For each seeker a place for its centre; none: it must wait. draw: makes the random points of this step others than
// those of other steps. Collective.
std::vector<std::optional<FreePlace>> free_places(std::span<const PlaceSeeker> seekers, const GrainsAround& grains,
                                                  const Surroundings& surroundings, std::uint64_t draw,
                                                  MPI_Comm communicator);

}  // namespace thalweg::dem
