// The places that grains of a random packing try, one after the other, and the error where they do not fit.
#pragma once

#include "beds/packing/random_packing.hpp"
#include "core/base/error.hpp"

#include <cstdint>

namespace thalweg::beds {

inline constexpr unsigned most_attempts_at_random = 5000;  // of one grain

// m, wrapped; grains and attempts are numbered from 0 on. The region must have room for the grain.
Vec3 random_place(const PeriodicBox& box, const GrainsToPlace& grains, std::int64_t number, unsigned attempt);

// Whether the largest grain fits between the faces of the region.
bool has_room_at_random(const PeriodicBox& box, const GrainsToPlace& grains);

// placed: how many grains did fit.
InputError too_many_at_random(const GrainsToPlace& grains, std::int64_t placed);

}  // namespace thalweg::beds
