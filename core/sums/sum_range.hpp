// Range check of the exact sums of this process (fixed_point.hpp). A term or sum out of range sets a flag, and the time
// loop ends the run before any such state is written.
#pragma once

#include <cstdint>

namespace thalweg {

class SumRange {
public:
  static void leave() { left_ = true; }
  static bool was_left() { return left_; }
  static void reset() { left_ = false; }

private:
  static inline bool left_ = false;
};

// a + b; on overflow it wraps around and sets the flag.
inline std::int64_t exact_sum(std::int64_t a, std::int64_t b) {
  std::int64_t sum = 0;
  if (__builtin_add_overflow(a, b, &sum)) [[unlikely]]
    SumRange::leave();
  return sum;
}

// a b, likewise.
inline std::int64_t exact_product(std::int64_t a, std::int64_t b) {
  std::int64_t product = 0;
  if (__builtin_mul_overflow(a, b, &product)) [[unlikely]]
    SumRange::leave();
  return product;
}

}  // namespace thalweg
