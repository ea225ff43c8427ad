// Counts as MPI takes them: an int, which ends at 2^31.
#pragma once

#include "core/base/error.hpp"

#include <fmt/format.h>

#include <concepts>
#include <limits>
#include <utility>

namespace thalweg {

// The count of what one message, or one call for all ranks, carries. Throws RunError where that is more than MPI takes:
// one rank has so much only where there are too few of them.
template <std::integral Count>
int mpi_count(Count count) {
  if (!std::in_range<int>(count))
    throw RunError(fmt::format("One message of {} items was to be sent, and MPI takes at most {}; use more ranks.",
                               count, std::numeric_limits<int>::max()));
  return static_cast<int>(count);
}

}  // namespace thalweg
