// Reaction to diagnostics that leave their bounds.
#pragma once

namespace thalweg::loop {

enum class OutOfBounds { stop, warn };  // beyond the second limit

}  // namespace thalweg::loop
