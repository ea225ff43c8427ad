#include "core/state/same_time_step.hpp"

#include "core/base/error.hpp"

#include <fmt/format.h>

namespace thalweg {

void require_same_time_step(ArchiveReader& archive, double time_step, int steps) {
  const double saved = archive.real_attribute("system/time_step");
  if (saved != time_step)
    throw InputError(
        fmt::format("The checkpoint was made with {:.6g} s a step and this case has {:.6g} s: a restart keeps "
                    "its time step; to change it, begin a new run from that state with initial.from.",
                    saved / steps, time_step / steps));
}

}  // namespace thalweg
