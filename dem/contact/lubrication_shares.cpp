#include "dem/contact/lubrication_shares.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace thalweg::dem {

namespace {

constexpr double rounding = 1e-9;  // of a radius: a point of its own surface is not inside a member

// True if a point, given from the centre of a sphere of its body, is inside the other sphere.
bool is_inside(const Vec3& point, const Vec3& centre, const Vec3& other_centre, double other_radius,
               const PeriodicBox& box) {
  const double inner = (1.0 - rounding) * other_radius;
  return (box.difference(centre, other_centre) + point).squaredNorm() < inner * inner;
}

class SharedFilm {
public:
  // group: numbers of the places of two bodies, ascending.
  SharedFilm(std::span<const NearPlace> places, std::span<const std::size_t> group, const PeriodicBox& box)
      : places_(places), box_(box) {
    for (const std::size_t n : group)
      if (!is_hidden(n, group)) visible_.push_back(n);
  }

  void set_shares(std::vector<double>& shares) const {
    for (const std::size_t e : visible_) {
      double sum = 0.0;
      for (const std::size_t f : visible_) sum += square(strength(f)) * overlap(e, f);
      shares[e] = square(strength(e)) / sum;
    }
  }

private:
  static double square(double x) { return x * x; }
  double strength(std::size_t n) const { return square(places_[n].reduced_radius) / places_[n].gap; }
  // From the centre of the first to its near point, m.
  Vec3 near_point(std::size_t n) const { return -places_[n].first_radius * places_[n].normal; }

  bool is_hidden(std::size_t n, std::span<const std::size_t> group) const {
    const NearPlace& place = places_[n];
    return std::any_of(group.begin(), group.end(), [&](std::size_t m) {
      const NearPlace& other = places_[m];
      return is_inside(near_point(n), place.first_centre, other.first_centre, other.first_radius, box_) ||
             is_inside(place.second_radius * place.normal, place.second_centre, other.second_centre,
                       other.second_radius, box_);
    });
  }
  // k_ef
  double overlap(std::size_t e, std::size_t f) const {
    if (e != f && places_[e].first == places_[f].first && places_[e].second == places_[f].second) return 0.0;
    const Vec3 apart =
        box_.difference(places_[e].first_centre, places_[f].first_centre) + near_point(e) - near_point(f);
    return 1.0 / square(1.0 + apart.squaredNorm() / (2.0 * places_[e].reduced_radius * places_[e].gap));
  }

  std::span<const NearPlace> places_;
  const PeriodicBox& box_;
  std::vector<std::size_t> visible_;
};

}  // namespace

std::vector<double> lubrication_shares(std::span<const NearPlace> places, const PeriodicBox& box) {
  const auto bodies = [&](std::size_t n) { return std::pair(places[n].first_body, places[n].second_body); };
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return bodies(a) < bodies(b); });
  std::vector<double> shares(places.size(), 0.0);
  for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
    while (last < order.size() && bodies(order[last]) == bodies(order[first])) ++last;
    if (last - first == 1)
      shares[order[first]] = 1.0;
    else
      SharedFilm(places, std::span(order).subspan(first, last - first), box).set_shares(shares);
  }
  return shares;
}

}  // namespace thalweg::dem
