// What to do with a run whose diagnostics leave their bounds.
#pragma once

namespace thalweg::loop {

enum class OutOfBounds { stop, warn };  // beyond the second limit

}  // namespace thalweg::loop
