// A contact law at the surface of a solid: the contact also keeps its normal, by which its history is found again when
// it has moved on (solid_contacts.hpp).
#pragma once

#include "dem/laws/contact_law.hpp"

#include <array>
#include <tuple>

namespace thalweg::dem {

template <typename Inner>
class AtSurface {
public:
  using Coefficients = typename Inner::Coefficients;
  using Constants = typename Inner::Constants;
  static constexpr std::size_t of_inner = std::tuple_size_v<typename Inner::History>;
  using History = std::array<double, of_inner + 3>;  // after the law's: the normal
  static constexpr std::array history_parts = joined(Inner::history_parts, HistoryPart{"surface_normal", 3});
  static constexpr bool rolls = Inner::rolls;

  explicit AtSurface(const Inner& inner) : inner_(inner) {}

  double range() const { return inner_.range(); }
  static Constants constants_of(const ContactBodies& bodies) { return Inner::constants_of(bodies); }

  ContactLoad operator()(const ContactMotion& c, const Coefficients& k, const Constants& constants,
                         History& history) const {
    auto kept = first_of<of_inner>(history);
    const ContactLoad load = inner_(c, k, constants, kept);
    history = appended(kept, c.nx, c.ny, c.nz);
    return load;
  }

private:
  Inner inner_;
};

}  // namespace thalweg::dem
