// Drag between grains and fluid (Zhang et al. 2022, section 3.1.3): the force of the grains on the fluid per volume is
//
//   f = 18 phi (1 - phi) eta/d^2 F(phi, Re_d) dU          eq. 25
//   Re_d = (1 - phi) rho_f |dU| d/eta                     (d is missing in print)
//   F_1  = F(0, Re_d) (1 - phi)^-3                        eq. 26 (Schiller and Naumann; Chauchat et al. 2017)
//   F_2                                                   eq. 27 (Beetstra et al. 2007)
//   F    = F_2/(1 - phi)                                  eq. 28, the paper's own
//
// In the denominator of F_2 Beetstra et al. have 10^(3 phi) Re^(-(1 + 4 phi)/2); the print shows 10^3 phi.
#pragma once

#include "continuum/mixture.hpp"
#include "core/keys/named_choice.hpp"

#include <vector>

namespace thalweg::continuum {

enum class DragFunction { mobile, beetstra, schiller };
std::vector<NamedChoice<DragFunction>> choices_of(DragFunction);

enum class DragCrowding { power, printed };
std::vector<NamedChoice<DragCrowding>> choices_of(DragCrowding);

struct Drag {
  DragFunction function = DragFunction::mobile;
  DragCrowding crowding = DragCrowding::power;  // of F_2
  bool operator==(const Drag&) const = default;
};

// Re_d of a velocity difference in m/s.
double drag_reynolds(const Mixture& mixture, double fraction, double difference);

double single_sphere_drag(double reynolds);                                     // F(0, Re_d)
double schiller_drag(double fraction, double reynolds);                         // F_1
double beetstra_drag(double fraction, double reynolds, DragCrowding crowding);  // F_2
double drag_function(const Drag& drag, double fraction, double reynolds);       // F

// 18 eta F/d^2, kg/(m^3 s): times phi (1 - phi) the force per volume and velocity difference.
double drag_rate(const Drag& drag, const Mixture& mixture, double fraction, double difference);

}  // namespace thalweg::continuum
