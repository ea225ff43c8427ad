#include "continuum/drag.hpp"

#include <algorithm>
#include <cmath>

namespace thalweg::continuum {

std::vector<NamedChoice<DragFunction>> choices_of(DragFunction) {
  return {{DragFunction::mobile, "mobile", "F_2/(1 - phi), eq. 28"},
          {DragFunction::beetstra, "beetstra", "F_2, eq. 27, of fixed grains"},
          {DragFunction::schiller, "schiller", "F_1, eq. 26"}};
}

std::vector<NamedChoice<DragCrowding>> choices_of(DragCrowding) {
  return {{DragCrowding::power, "power", "10^(3 phi), as in Beetstra et al. (2007)"},
          {DragCrowding::printed, "printed", "10^3 phi, as in Zhang et al. (2022)"}};
}

double drag_reynolds(const Mixture& mixture, double fraction, double difference) {
  return (1.0 - fraction) * mixture.fluid_density * std::abs(difference) * mixture.diameter / mixture.viscosity;
}

double single_sphere_drag(double reynolds) {
  return reynolds <= 1000.0 ? 1.0 + 0.15 * std::pow(reynolds, 0.687) : 0.44 / 24.0 * reynolds;
}

double schiller_drag(double fraction, double reynolds) {
  return single_sphere_drag(reynolds) / std::pow(1.0 - fraction, 3);
}

double beetstra_drag(double fraction, double reynolds, DragCrowding crowding) {
  const double n = 1.0 - fraction;
  const double stokes = 10.0 * fraction / (n * n) + n * n * (1.0 + 1.5 * std::sqrt(fraction));
  if (!(reynolds > 0.0)) return stokes;
  const double crowd = crowding == DragCrowding::power ? std::pow(10.0, 3.0 * fraction) : 1000.0 * fraction;
  return stokes + 0.413 * reynolds / (24.0 * n * n) *
                      (1.0 / n + 3.0 * fraction * n + 8.4 * std::pow(reynolds, -0.343)) /
                      (1.0 + crowd * std::pow(reynolds, -0.5 * (1.0 + 4.0 * fraction)));
}

double drag_function(const Drag& drag, double fraction, double reynolds) {
  switch (drag.function) {
    case DragFunction::schiller:
      return schiller_drag(fraction, reynolds);
    case DragFunction::beetstra:
      return beetstra_drag(fraction, reynolds, drag.crowding);
    case DragFunction::mobile:
      break;
  }
  return beetstra_drag(fraction, reynolds, drag.crowding) / (1.0 - fraction);
}

double drag_rate(const Drag& drag, const Mixture& mixture, double fraction, double difference) {
  return 18.0 * mixture.viscosity * drag_function(drag, fraction, drag_reynolds(mixture, fraction, difference)) /
         (mixture.diameter * mixture.diameter);
}

}  // namespace thalweg::continuum
