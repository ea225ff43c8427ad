// A settled bed of 5 mm glass spheres over a floor, periodic in plan, made by the program itself: the same grains on
// any number of ranks and on any machine with the same arithmetic.
#pragma once

#include "core/parallel/decomposition.hpp"
#include "dem/grain_dynamics.hpp"

#include <mpi.h>

#include <array>
#include <vector>

namespace thalweg::benchmark {

inline constexpr double diameter = 5e-3;  // m
inline constexpr int tile_grains = 2884;
inline constexpr double gravity = 9.8;  // m/s^2

// How many copies of the tile, 24 x 8 diameters in plan and about 13 deep, lie side by side.
using Tiles = std::array<int, 2>;

// k_n = 20000 N/m, k_t = 5714 N/m, mu = 0.5; restitution as given; gravity downwards; a floor.
dem::GrainParameters bed_parameters(double restitution, const PeriodicBox& box);

// The box of so many tiles, shared among the ranks in columns.
Decomposition bed_decomposition(const Tiles& tiles, int ranks);

// Grains dropped at random onto the floor of one tile and left until they lie. Collective; the same list on every rank.
std::vector<dem::GrainSeed> settle_tile(MPI_Comm communicator);

// Copies of a settled tile side by side, at rest.
std::vector<dem::GrainSeed> lay_tiles(const std::vector<dem::GrainSeed>& tile, const Tiles& tiles);

}  // namespace thalweg::benchmark
