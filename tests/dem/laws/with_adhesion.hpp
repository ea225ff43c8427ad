// A contact law added by a contributor, as CONTRIBUTING.md describes: another law with the adhesion of Derjaguin,
// Muller and Toporov (J. Colloid Interface Sci. 53 (1975) 314), while the surfaces touch:
//
//   F_n = F_n of the other law - 2 pi R w,   R = R1 R2/(R1 + R2),   w: work of adhesion, J/m^2
//
// A law with a history of its own, or one that acts across a gap, is dem/laws/liquid_bridge.hpp.
#pragma once

#include "dem/laws/contact_law.hpp"

#include <numbers>

namespace thalweg::dem {

template <IsContactLaw Inner>
class WithAdhesion {
public:
  using Coefficients = typename Inner::Coefficients;
  using Constants = typename Inner::Constants;
  using History = typename Inner::History;
  static constexpr std::array history_parts = Inner::history_parts;
  static constexpr bool rolls = Inner::rolls;

  WithAdhesion(const Inner& inner, double work_of_adhesion) : inner_(inner), work_(work_of_adhesion) {}

  double range() const { return inner_.range(); }
  static Constants constants_of(const ContactBodies& bodies) { return Inner::constants_of(bodies); }

  ContactLoad operator()(const ContactMotion& c, const Coefficients& k, const Constants& constants,
                         History& history) const {
    ContactLoad load = inner_(c, k, constants, history);
    load.normal -= c.overlap > 0.0 ? 2.0 * std::numbers::pi * c.effective_radius * work_ : 0.0;
    return load;
  }

private:
  Inner inner_;
  double work_;  // J/m^2
};

}  // namespace thalweg::dem
