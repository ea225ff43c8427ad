// Subgrid models: the eddy viscosity nu_t of what the lattice does not resolve, from the rate of strain S of a cell.
// Lattice units, |S| = sqrt(2 S_ab S_ab).
//
//   smagorinsky  nu_t = C_s^2 |S|                                                                  (Smagorinsky 1963)
//   qr           nu_t = C max(0, -det S)/(S_ab S_ab/2),  C = 0.3                                   (Verstappen 2011)
//                The least that keeps eddies smaller than a cell from growing. It vanishes in simple shear and in any
//                flow in two dimensions, so also in laminar water along a wall. The constant is that with which
//                turbulence decays as measured (benchmarks/validation/decaying_turbulence).
//
// The lattice knows S through the non-equilibrium moment Pi of cell_moments.hpp, S = -3 Pi/(2 rho tau) with the
// relaxation time tau = tau_0 + 3 nu_t that follows from it. Either model then has a closed form:
//   tau = [tau_0 + sqrt(tau_0^2 + E/rho)]/2,   smagorinsky: E = 18 sqrt(2) C_s^2 sqrt(Pi_ab Pi_ab)   (Hou et al. 1996)
//                                              qr:          E = 36 C max(0, det P)/(P_ab P_ab), P the traceless part
#pragma once

#include "core/keys/named_choice.hpp"
#include "lbm/lattice/symmetric.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <vector>

namespace thalweg::lbm {

enum class SubgridModel { none, smagorinsky, qr };

// The words in a case file (core/keys/section_visitor.hpp).
std::vector<NamedChoice<SubgridModel>> choices_of(SubgridModel);

// Calls visit.operator()<model>() with the model as a constant.
template <typename Visit>
decltype(auto) with_constant(SubgridModel model, Visit visit) {
  switch (model) {
    case SubgridModel::none:
      return visit.template operator()<SubgridModel::none>();
    case SubgridModel::smagorinsky:
      return visit.template operator()<SubgridModel::smagorinsky>();
    case SubgridModel::qr:
      return visit.template operator()<SubgridModel::qr>();
  }
  __builtin_unreachable();
}

// A model and its constant.
class Subgrid {
public:
  Subgrid() = default;  // none
  static Subgrid none() { return {}; }
  static Subgrid smagorinsky(double constant) {
    return constant > 0.0 ? Subgrid(SubgridModel::smagorinsky, constant) : Subgrid();
  }
  static Subgrid qr() { return {SubgridModel::qr, 0.3}; }

  SubgridModel model() const { return model_; }
  bool on() const { return model_ != SubgridModel::none; }
  double constant() const { return constant_; }  // C_s or C; 0 without a model

  // nu_t in simple shear at this rate.
  double viscosity_in_shear(double rate) const {
    switch (model_) {
      case SubgridModel::none:
      case SubgridModel::qr:
        return 0.0;
      case SubgridModel::smagorinsky:
        return constant_ * constant_ * rate;
    }
    __builtin_unreachable();
  }

  // The factor of E that comes before what subgrid_invariant() takes from Pi.
  double closure_factor() const {
    switch (model_) {
      case SubgridModel::none:
        return 0.0;
      case SubgridModel::smagorinsky:
        return 18.0 * std::numbers::sqrt2 * constant_ * constant_;
      case SubgridModel::qr:
        return 36.0 * constant_;
    }
    __builtin_unreachable();
  }

  bool operator==(const Subgrid&) const = default;

private:
  Subgrid(SubgridModel model, double constant) : model_(model), constant_(constant) {}

  SubgridModel model_ = SubgridModel::none;
  double constant_ = 0.0;
};

// E over the closure_factor(). `own_bulk`: the trace of Pi has a relaxation time of its own, and is then no sign of
// shear.
template <SubgridModel model, bool own_bulk, typename Number>
[[gnu::always_inline]] inline Number subgrid_invariant(const Symmetric<Number>& pi) {
  using std::max;
  using std::sqrt;
  if constexpr (model == SubgridModel::smagorinsky) {
    if constexpr (own_bulk)
      return sqrt(pi.traceless().squared());
    else
      return sqrt(pi.squared());
  } else {
    static_assert(model == SubgridModel::qr);
    constexpr auto constant = pack_constant<Number>;
    const Symmetric<Number> p = pi.traceless();
    // The smallest square keeps a fluid at rest from 0/0.
    return max(p.determinant(), constant(0)) / (p.squared() + constant(1e-30));
  }
}

}  // namespace thalweg::lbm
