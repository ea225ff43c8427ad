// Building blocks of contact laws. A law is one class: spring_dashpot.hpp and hertz_mindlin.hpp stand alone,
// kinetic_friction.hpp, rolling_friction.hpp and liquid_bridge.hpp add to another law, and contact_laws.hpp lists them
// all. The concept IsContactLaw below checks that such a class has
//
//   Coefficients    doubles that two materials have together, among them `damping_ratio` and `damping` (material.hpp);
//                   the last one is `friction`, which walls replace by theirs
//   Constants       doubles that a contact has from its two bodies, by constants_of() when it is listed
//   History         doubles that a contact keeps from one evaluation to the next, zero in a new one
//   history_parts   their names, in which files have them
//   rolls           whether it uses the spin of the bodies against each other and gives a moment
//   range()         m, the gap up to which it may act: beyond it there is no force and no history
//   operator()(motion, coefficients, constants, history)   the load; brings the history to the end of the step
//
// No other code interprets these doubles.
//
// v is the velocity of the first body's surface against the second's at the contact, n the unit normal from the second
// body to the first, delta the overlap. Force on the first body: F_n n + F_t. SI units.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>

namespace thalweg::dem {

// Plain values and no branches, so that a loop over contacts in arrays is vectorised by the compiler.
struct ContactMotion {
  double overlap;                 // m; across a gap negative
  double nx, ny, nz;              // unit normal
  double vx, vy, vz;              // m/s
  double effective_radius;        // m, R1 R2/(R1 + R2); R against a wall
  double wx = 0, wy = 0, wz = 0;  // rad/s, spin of the first body against the second; for laws that roll
};

// Properties of the two bodies of a contact, given to the law when the contact is listed.
struct ContactBodies {
  double critical_damping;  // 2 sqrt(k m*), kg/s, or kg/(s m^1/2) of elastic spheres (material.hpp)
  double rolling_friction;  // mu_r
  double rolling_inertia;   // kg m^2, I_r of rolling_friction.hpp
};

struct ContactLoad {
  double normal;                  // N, positive pushes the bodies apart
  double tx, ty, tz;              // N: F_t
  double mx = 0, my = 0, mz = 0;  // N m: moment on the first body beyond that of the force, its opposite on the second
};

struct HistoryPart {
  const char* name;
  std::size_t size;
};

// Number of doubles in all these parts.
constexpr std::size_t doubles_of(std::span<const HistoryPart> parts) {
  std::size_t size = 0;
  for (const HistoryPart& part : parts) size += part.size;
  return size;
}

// Number of doubles in a struct of doubles.
template <typename Doubles>
inline constexpr std::size_t doubles_in = sizeof(Doubles) / sizeof(double);

// The form of a law. Its history is as long as the parts that it names.
template <typename Law>
concept IsContactLaw = requires(const Law& law, const ContactMotion& motion,
                                const typename Law::Coefficients& coefficients,
                                const typename Law::Constants& constants, typename Law::History& history,
                                const ContactBodies& bodies) {
  { coefficients.damping_ratio } -> std::convertible_to<double>;
  { coefficients.damping } -> std::convertible_to<double>;
  { coefficients.friction } -> std::convertible_to<double>;
  { Law::constants_of(bodies) } -> std::same_as<typename Law::Constants>;
  { law.range() } -> std::same_as<double>;
  { law(motion, coefficients, constants, history) } -> std::same_as<ContactLoad>;
  requires std::same_as<decltype(Law::rolls), const bool>;
  requires doubles_of(Law::history_parts)
  == std::tuple_size_v<typename Law::History>;
};

// Joined parts and histories, for laws that add to another.
template <std::size_t n>
constexpr std::array<HistoryPart, n + 1> joined(const std::array<HistoryPart, n>& parts, const HistoryPart& last) {
  std::array<HistoryPart, n + 1> all{};
  for (std::size_t p = 0; p < n; ++p) all[p] = parts[p];
  all[n] = last;
  return all;
}

template <std::size_t n, typename History>
std::array<double, n> first_of(const History& history) {
  return [&]<std::size_t... i>(std::index_sequence<i...>) { return std::array<double, n>{history[i]...}; }
  (std::make_index_sequence<n>());
}

template <std::size_t n, typename... Doubles>
std::array<double, n + sizeof...(Doubles)> appended(const std::array<double, n>& history, Doubles... more) {
  return [&]<std::size_t... i>(std::index_sequence<i...>) {
    return std::array<double, n + sizeof...(Doubles)>{history[i]..., more...};
  }
  (std::make_index_sequence<n>());
}

template <std::size_t n, typename Change>
std::array<double, n> each(const std::array<double, n>& history, const Change& change) {
  return [&]<std::size_t... i>(std::index_sequence<i...>) { return std::array<double, n>{change(history[i])...}; }
  (std::make_index_sequence<n>());
}

// The normal spring of a law at the present overlap, for springs that act across it: in a step such a spring is scaled
// by `keep` and grows by `growth` times the velocity.
struct NormalSpring {
  double stiffness;  // N/m, of elastic spheres Pa: k_n = stiffness * scale
  double scale;      // 1, or the contact radius, m
  double growth;     // scale times the time step
  double keep;       // 1, or a/a_before while the contact opens
};

struct TangentialSpring {
  double x, y, z;  // linear: displacement xi, m;  Hertz: xi times contact radius, m^2
};

struct Friction {
  double x, y, z;  // N: F_t
  TangentialSpring spring;
};

// Friction across the contact (Cundall & Strack, Geotechnique 29 (1979) 47). The spring is turned into the present
// tangent plane, keeping its length (to the fourth order of the angle, which is that of one sub-step), shortened by
// `keep` and grown by growth v_t; F_t = -stiffness xi - damping v_t, both shortened to |F_t| <= mu |F_n| while the
// contact slides. closing: -v.n, m/s; normal: F_n, N.
inline Friction friction_of(const ContactMotion& c, double closing, double normal, double friction, double stiffness,
                            double damping, double keep, double growth, const TangentialSpring& spring) {
  const double off = spring.x * c.nx + spring.y * c.ny + spring.z * c.nz;
  const double px = spring.x - off * c.nx, py = spring.y - off * c.ny, pz = spring.z - off * c.nz;
  const double length2 = spring.x * spring.x + spring.y * spring.y + spring.z * spring.z;
  // 1/sqrt(1 - q) to first order, q being the squared sine of the angle: never more than 3/2, whatever the rounding.
  const double stretch = length2 > 0.0 ? keep * (1.0 + 0.5 * (off * off / length2)) : 0.0;
  const double ux = c.vx + closing * c.nx, uy = c.vy + closing * c.ny, uz = c.vz + closing * c.nz;
  const double x = stretch * px + growth * ux, y = stretch * py + growth * uy, z = stretch * pz + growth * uz;

  const double fx = stiffness * x + damping * ux, fy = stiffness * y + damping * uy, fz = stiffness * z + damping * uz;
  const double tangential = std::sqrt(fx * fx + fy * fy + fz * fz), limit = friction * std::fabs(normal);
  const double hold = tangential > limit ? limit / tangential : 1.0;
  // The share of the spring that is lost while the dashpot keeps its share of the shortened force.
  const double share = damping > 0.0 && stiffness > 0.0 ? (1.0 - hold) * damping / stiffness : 0.0;
  return {-hold * fx, -hold * fy, -hold * fz, {hold * x - share * ux, hold * y - share * uy, hold * z - share * uz}};
}

}  // namespace thalweg::dem
