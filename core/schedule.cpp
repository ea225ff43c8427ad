#include "core/schedule.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg {

Schedule::Schedule(double every, double time_step)
    : interval_(every > 0.0 ? std::max<std::int64_t>(1, std::llround(every / time_step)) : 0) {}

}  // namespace thalweg
