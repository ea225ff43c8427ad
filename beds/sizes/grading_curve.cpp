#include "beds/sizes/grading_curve.hpp"

#include "beds/sizes/normal_distribution.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace thalweg::beds {
namespace {

constexpr double z_step = 0.01;        // deviations between points; off by a tenth of its square times the peak of 0.4
constexpr double farthest_tail = 6.0;  // deviations, beyond which there are 1e-9 of the mass

// One distribution between two of its sizes, at z deviations of ln d from the median.
struct NormalPiece {
  double median, deviation;  // m, and of ln d
  double z_from, z_to;
  double below, upto;  // shares of the mass of all pieces at the ends
};

// Adds a piece without its first point.
void add(const NormalPiece& piece, GradingCurve& curve) {
  const double first = normal_share_below(piece.z_from), last = normal_share_below(piece.z_to);
  const int points = std::max(1, static_cast<int>(std::ceil((piece.z_to - piece.z_from) / z_step)));
  for (int n = 1; n <= points; ++n) {
    const double z = n < points ? piece.z_from + n * (piece.z_to - piece.z_from) / points : piece.z_to;
    const double way = n < points ? (normal_share_below(z) - first) / (last - first) : 1.0;
    curve.diameters.push_back(piece.median * std::exp(piece.deviation * z));
    curve.finer.push_back(piece.below + (piece.upto - piece.below) * way);
  }
}

// Number of grains coarser than a size, in units of the number of the smallest grains that have all of the mass.
class NumberCurve {
public:
  struct Location {
    double diameter, finer;
  };

  NumberCurve(const GradingCurve& curve, double mass_power)
      : curve_(curve), mass_power_(mass_power), coarser_(curve.diameters.size(), 0.0) {
    for (std::size_t n = coarser_.size() - 1; n-- > 0;)
      coarser_[n] = coarser_[n + 1] + steepness(n) * (inverse_mass(n) - inverse_mass(n + 1));
  }

  double total() const { return coarser_.front(); }

  // Location at which this share of the number is coarser. Summed up from the coarse end, where a few grains have much
  // of the mass.
  Location location_of(double share_coarser) const {
    const double number = share_coarser * total();
    const auto above = std::partition_point(coarser_.begin() + 1, coarser_.end() - 1,
                                            [number](double coarser) { return coarser > number; });
    const auto n = static_cast<std::size_t>(above - coarser_.begin()) - 1;
    const std::vector<double>& d = curve_.diameters;
    if (curve_.finer[n + 1] == curve_.finer[n]) return {d[n + 1], curve_.finer[n]};
    const double inverse = inverse_mass(n + 1) + (number - coarser_[n + 1]) / steepness(n);
    const double diameter = std::clamp(diameter_of(1.0 / inverse), d[n], d[n + 1]);
    const double way = std::log(diameter / d[n]) / std::log(d[n + 1] / d[n]);
    return {diameter, curve_.finer[n] + way * (curve_.finer[n + 1] - curve_.finer[n])};
  }

  // m, of a grain of this mass in those of the smallest.
  double diameter_of(double mass) const { return curve_.diameters.front() * std::pow(mass, 1.0 / mass_power_); }

private:
  double inverse_mass(std::size_t n) const {
    return std::pow(curve_.diameters.front() / curve_.diameters[n], mass_power_);
  }

  // dF/d(ln d) of the piece above point n, over the power.
  double steepness(std::size_t n) const {
    return (curve_.finer[n + 1] - curve_.finer[n]) /
           (mass_power_ * std::log(curve_.diameters[n + 1] / curve_.diameters[n]));
  }

  const GradingCurve& curve_;
  double mass_power_;
  std::vector<double> coarser_;
};

}  // namespace

GradingCurve curve_through(double minimum, double d16, double d50, double d84, double maximum) {
  const double z84 = normal_quantile(0.84, 0.0, farthest_tail);
  const double fine = std::log(d50 / d16) / z84, coarse = std::log(d84 / d50) / z84;
  const double lowest = std::max(std::log(minimum / d50) / fine, -farthest_tail);
  const double highest = std::min(std::log(maximum / d50) / coarse, farthest_tail);
  GradingCurve curve{{d50 * std::exp(fine * lowest)}, {0.0}};
  add({d50, fine, lowest, -z84, 0.0, 0.16}, curve);
  add({d50, fine, -z84, 0.0, 0.16, 0.5}, curve);
  add({d50, coarse, 0.0, z84, 0.5, 0.84}, curve);
  add({d50, coarse, z84, highest, 0.84, 1.0}, curve);
  return curve;
}

std::vector<double> diameters_by_mass(const GradingCurve& curve, std::int64_t count, double mass_power) {
  const NumberCurve numbers(curve, mass_power);
  const auto all = static_cast<double>(count);
  std::vector<double> diameters;
  NumberCurve::Location lower{curve.diameters.front(), 0.0};
  for (std::int64_t n = 1; n <= count; ++n) {
    const NumberCurve::Location upper = numbers.location_of(static_cast<double>(count - n) / all);
    const double mean = numbers.diameter_of((upper.finer - lower.finer) * all / numbers.total());
    diameters.push_back(std::clamp(mean, lower.diameter, upper.diameter));
    lower = upper;
  }
  return diameters;
}

}  // namespace thalweg::beds
