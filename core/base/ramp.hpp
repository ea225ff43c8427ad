// A smooth rise from 0 to 1 during a given time T from time zero: s(t) = 3 x^2 - 2 x^3, x = t/T, 0 before and 1 after.
#pragma once

#include <algorithm>

namespace thalweg {

// The mean of s over the time from `from` to the later `to`, in the unit of the duration T. With S(x) = x^3 - x^4/2 the
// integral of s, it is [S(b) - S(a)]/(b - a) written out, so that a step far shorter than T costs no digits. Over
// consecutive steps of any length a force thus gives the integral of the ramp. Time zero falls between two steps; a
// duration of 0 is a jump there.
inline double ramp_mean(double from, double to, double duration) {
  if (to <= 0.0) return 0.0;
  if (from >= duration) return 1.0;
  const double a = std::max(0.0, from / duration), b = std::clamp(to / duration, 0.0, 1.0);
  const double rising = a * a + a * b + b * b - 0.5 * (a + b) * (a * a + b * b);
  return ((b - a) * duration * rising + std::max(0.0, to - duration)) / (to - from);
}

// s at a time, in the unit of the duration; a duration of 0 is a jump at time zero.
inline double ramp_at(double time, double duration) {
  if (time >= duration) return 1.0;
  const double x = std::max(0.0, time / duration);
  return x * x * (3.0 - 2.0 * x);
}

}  // namespace thalweg
