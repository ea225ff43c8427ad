// Average of the momentum exchanged in this and earlier steps, which is the load on the grains.
//
// With F_n the exchange between t_n and t_n+1:
//   mean          M_n = (F_n + F_n-1)/2: takes out the part that alternates from step to step (Ladd 1994)
//   extrapolated  2 M_n - M_n-1 = F_n + F_n-1/2 - F_n-2/2: the same, without a lag
// The mean belongs to the time t_n, and the walls that made it moved with the velocity of t_n instead of that half a
// step later: together a lag of one step. A grain that oscillates with the compressible fluid around it, as a mass on a
// spring with frequency omega per step, gains amplitude by omega^2/2 times the lag per step. A single grain radiates
// more than that. Among other grains the sound does not leave, and where little viscosity damps it, a bed shakes itself
// apart. Extrapolated by one step, the load has no lag. With K = 6 sum w_i c_ia c_ia/3 over the links, the resistance
// of the fluid to a sudden motion (3.8 dx/d of the displaced mass for a sphere), and m the mass of the grain, this
// load is stable up to K = 1.15 m, the mean up to 2 m.
#pragma once

#include "core/base/types.hpp"
#include "core/keys/named_choice.hpp"

#include <vector>

namespace thalweg::coupling {

enum class LoadAveraging { extrapolated, mean };
std::vector<NamedChoice<LoadAveraging>> choices_of(LoadAveraging);  // its words in a case file

// Exchanges before the first count as zero, so that every exchange gives its full impulse.
inline Vec3 averaged_load(LoadAveraging rule, const Vec3& now, const Vec3& last, const Vec3& before_last) {
  if (rule == LoadAveraging::mean) return 0.5 * (now + last);
  return now + 0.5 * (last - before_last);
}

}  // namespace thalweg::coupling
