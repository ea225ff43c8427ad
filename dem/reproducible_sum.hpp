// Sums over the grains of all ranks whose bits do not depend on who owns which grain.
#pragma once

#include "core/types.hpp"

#include <mpi.h>

#include <span>

namespace thalweg::dem {

// Every term is rounded to a multiple of a common power of two, chosen from the largest term (a maximum over ranks) and
// the number of terms so that integer sums cannot overflow; the rounding of a term is below 2^-60 times the largest
// possible sum (number of terms times largest term). Collective. Not a number if a term is not finite.
double reproducible_sum(MPI_Comm communicator, std::span<const double> terms);

}  // namespace thalweg::dem
