// A state belongs to the time step it was made with.
#pragma once

#include "core/base/archive.hpp"

namespace thalweg {

// Throws InputError if the state in the archive was made with another time step (s) than this one. steps: that many of
// the user's steps, which the message names, are one here.
void require_same_time_step(ArchiveReader& archive, double time_step, int steps = 1);

}  // namespace thalweg
