// Static and kinetic friction: a contact sticks up to mu |F_n| and, once it slides, slides under r mu |F_n| until less
// than that holds it [Luding, Granular Matter 10 (2008) 235].
//
// The contact remembers whether it slides. Without that memory the spring of a slow slide would grow from the kinetic
// to the static limit again and again, and the mean friction would lie between the two. The force falls to the kinetic
// limit in the sub-step after the one that reached the static limit.
#pragma once

#include "dem/laws/contact_law.hpp"
#include "dem/laws/contact_parameters.hpp"

#include <array>
#include <cmath>
#include <tuple>

namespace thalweg::dem {

// Another law, of springs and friction, with less friction while the contact slides.
template <typename Inner>
class WithKineticFriction {
public:
  using Coefficients = typename Inner::Coefficients;
  using Constants = typename Inner::Constants;
  static constexpr std::size_t of_inner = std::tuple_size_v<typename Inner::History>;
  using History = std::array<double, of_inner + 1>;  // after the law's: 1 while the contact slides, else 0
  static constexpr std::array history_parts = joined(Inner::history_parts, HistoryPart{"sliding", 1});
  static constexpr bool rolls = Inner::rolls;

  WithKineticFriction(const Inner& inner, const ContactParameters& common)
      : inner_(inner), ratio_(common.kinetic_friction_ratio) {}

  double range() const { return inner_.range(); }
  static Constants constants_of(const ContactBodies& bodies) { return Inner::constants_of(bodies); }
  NormalSpring normal_spring(const ContactMotion& c, const Coefficients& k) const { return inner_.normal_spring(c, k); }

  ContactLoad operator()(const ContactMotion& c, const Coefficients& k, const Constants& constants,
                         History& history) const {
    auto kept = first_of<of_inner>(history);
    Coefficients now = k;
    now.friction = k.friction * (history[of_inner] > 0.0 ? ratio_ : 1.0);
    const ContactLoad load = inner_(c, now, constants, kept);
    // The inner law shortens the force of a contact that slides to this limit, up to rounding.
    constexpr double shortened = 1.0 - 1e-12;
    const double limit = shortened * now.friction * std::fabs(load.normal);
    const double squared = load.tx * load.tx + load.ty * load.ty + load.tz * load.tz;
    history = appended(kept, squared > limit * limit ? 1.0 : 0.0);
    return load;
  }

private:
  Inner inner_;
  double ratio_;  // r
};

}  // namespace thalweg::dem
