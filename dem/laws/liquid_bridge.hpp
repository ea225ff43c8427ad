// A drop of liquid between two grains, or a grain and a wall, that holds them together: a pendular bridge of constant
// volume V with surface tension gamma and contact angle theta. It forms when they touch and breaks at the gap s_c:
//
//   F_n = F_n of the touching surfaces - 2 pi R gamma cos(theta)/(1 + 1.05 s + 2.5 s^2),   s = gap sqrt(R/V)
//   s_c = (1 + theta/2) V^(1/3)
//
// Force: closed form of Willett, Adams, Johnson & Seville, Langmuir 16 (2000) 9396, with R = 2 R1 R2/(R1 + R2),
// at a wall 2 R1 (Derjaguin); at an overlap it is that of gap zero. Break: Lian, Thornton & Adams, J. Colloid Interface
// Sci. 161 (1993) 138. Valid for V < 0.1 R^3 and drops so small that their weight does not matter; the viscosity of the
// liquid is neglected. Friction and rolling friction depend on the force of the touching surfaces, which the bridge
// presses together. SI units.
#pragma once

#include "dem/laws/contact_law.hpp"
#include "dem/laws/contact_parameters.hpp"

#include <array>
#include <cmath>
#include <tuple>

namespace thalweg::dem {

class LiquidBridge {
public:
  explicit LiquidBridge(const LiquidBridgeParameters& parameters);

  double rupture_distance() const { return rupture_; }  // m

  // N. gap: m, not negative; effective_radius: m, R1 R2/(R1 + R2).
  double pull(double gap, double effective_radius) const {
    const double radius = 2.0 * effective_radius, s = gap * std::sqrt(radius * inverse_volume_);
    return strength_ * radius / (1.0 + s * (1.05 + 2.5 * s));
  }

private:
  double strength_, inverse_volume_, rupture_;  // 2 pi gamma cos(theta), N/m; 1/m^3; m
};

void check(const LiquidBridgeParameters& parameters);  // throws InputError

// Another law, of touching surfaces, with a liquid bridge.
template <typename Inner>
class WithLiquidBridge {
public:
  using Coefficients = typename Inner::Coefficients;
  using Constants = typename Inner::Constants;
  static constexpr std::size_t of_inner = std::tuple_size_v<typename Inner::History>;
  using History = std::array<double, of_inner + 1>;  // after the law's: 1 where there is a bridge, else 0
  static constexpr std::array history_parts = joined(Inner::history_parts, HistoryPart{"bridge", 1});
  static constexpr bool rolls = Inner::rolls;

  WithLiquidBridge(const Inner& inner, const LiquidBridgeParameters& parameters) : inner_(inner), bridge_(parameters) {}

  double range() const { return bridge_.rupture_distance(); }
  static Constants constants_of(const ContactBodies& bodies) { return Inner::constants_of(bodies); }

  ContactLoad operator()(const ContactMotion& c, const Coefficients& k, const Constants& constants,
                         History& history) const {
    auto kept = first_of<of_inner>(history);
    const ContactLoad solid = inner_(c, k, constants, kept);
    const bool touches = c.overlap > 0.0;
    const double gap = touches ? 0.0 : -c.overlap;
    const double reach = history[of_inner] > 0.0 ? bridge_.rupture_distance() : 0.0;  // of a bridge that there is
    const bool wet = -c.overlap < reach;
    const double pull = bridge_.pull(gap, c.effective_radius);
    const auto if_touching = [touches](double value) { return touches ? value : 0.0; };
    history = appended(each(kept, if_touching), wet ? 1.0 : 0.0);
    return {if_touching(solid.normal) - (wet ? pull : 0.0),
            if_touching(solid.tx),
            if_touching(solid.ty),
            if_touching(solid.tz),
            if_touching(solid.mx),
            if_touching(solid.my),
            if_touching(solid.mz)};
  }

private:
  Inner inner_;
  LiquidBridge bridge_;
};

}  // namespace thalweg::dem
