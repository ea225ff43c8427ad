// The grains of populations as rows of a saved state, in order of id, without positions: what grains taken over from
// another run must match.
#pragma once

#include "beds/population/population.hpp"
#include "core/parallel/ranks.hpp"
#include "core/parallel/row_range.hpp"
#include "dem/motion/grain_store.hpp"

#include <span>
#include <vector>

namespace thalweg::beds {

// A grain, or a member of a clump.
struct PopulationRow {
  double radius = 0.0;        // m
  double mass = 0.0;          // kg, of a member that of its clump; 0: of a clump from a file
  double contact_mass = 0.0;  // kg, no contact feels less
  dem::Motion motion = dem::Motion::free;
  int material = 0;
};

// The rows of a complete population (population_bed.hpp) that a rank compares with those of a state: its share of a
// file, otherwise an even share.
RowRange share_of_rows(const Population& population, const Ranks& ranks = {});

// Rows of one population in such a share.
std::vector<PopulationRow> rows_of(std::span<const Population> populations, std::size_t number, const RowRange& share);

}  // namespace thalweg::beds
