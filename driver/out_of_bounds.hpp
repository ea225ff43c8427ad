// What becomes of a run whose figures leave their bounds.
#pragma once

namespace thalweg::driver {

enum class OutOfBounds { stop, warn };  // beyond the second limit

}  // namespace thalweg::driver
