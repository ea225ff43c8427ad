// The square cavity at Re = 1000 by the textbook method (two lattices, D2Q9, bgk, half-way bounce-back): how the error
// depends on what the lid does at its ends.
//
//   g++ -O3 -march=native -ffast-math -std=c++20 lid_edges.cpp -o lid_edges && ./lid_edges CELLS FACTOR SMOOTH
//
// FACTOR: share of the lid's velocity in the populations that come out of the two corners (1 in Thalweg). SMOOTH 1: a
// lid velocity of 16 x^2 (1 - x)^2 in place of 1. Prints the extreme velocities on the centre lines after fifty times
// the lid needs to cross the cavity.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

constexpr int cx[9] = {0, 1, -1, 0, 0, 1, -1, 1, -1}, cz[9] = {0, 0, 0, 1, -1, 1, -1, -1, 1};
constexpr double weight[9] = {4 / 9., 1 / 9., 1 / 9., 1 / 9., 1 / 9., 1 / 36., 1 / 36., 1 / 36., 1 / 36.};
int opposite(int i) { return i == 0 ? 0 : ((i - 1) ^ 1) + 1; }

struct Cavity {
  int n;
  double factor;
  bool smooth;
  double speed = 6.5 / n, tau = 0.5 + 3.0 * 6.5 / 1000.0;
  std::vector<double> f = std::vector<double>(9 * n * n), g = f;

  void collide(double* h) const {
    double rho = 0, u = 0, w = 0;
    for (int i = 0; i < 9; ++i) rho += h[i], u += cx[i] * h[i], w += cz[i] * h[i];
    u /= rho, w /= rho;
    for (int i = 0; i < 9; ++i) {
      const double cu = cx[i] * u + cz[i] * w;
      h[i] -= (h[i] - weight[i] * rho * (1 + 3 * cu + 4.5 * cu * cu - 1.5 * (u * u + w * w))) / tau;
    }
  }

  double lid(double x) const { return smooth ? 16 * x * x * (1 - x) * (1 - x) * speed : speed; }

  void step() {
    for (int k = 0; k < n * n; ++k) collide(&f[9 * k]);
    for (int z = 0; z < n; ++z)
      for (int x = 0; x < n; ++x) {
        const double* h = &f[9 * (z * n + x)];
        double rho = 0;
        for (int i = 0; i < 9; ++i) rho += h[i];
        for (int i = 0; i < 9; ++i) {
          const int to_x = x + cx[i], to_z = z + cz[i];
          const bool beyond_side = to_x < 0 || to_x >= n;
          if (!beyond_side && to_z >= 0 && to_z < n) {
            g[9 * (to_z * n + to_x) + i] = h[i];
            continue;
          }
          double carried = 0;
          if (to_z >= n) carried = 6 * weight[i] * rho * cx[i] * lid((x + 0.5 + 0.5 * cx[i]) / n);
          g[9 * (z * n + x) + opposite(i)] = h[i] - (beyond_side ? factor : 1) * carried;
        }
      }
    std::swap(f, g);
  }

  double velocity(int x, int z, const int* c) const {
    const double* h = &f[9 * (z * n + x)];
    double rho = 0, m = 0;
    for (int i = 0; i < 9; ++i) rho += h[i], m += c[i] * h[i];
    return m / rho / speed;
  }
};

// Extreme of the polynomial through the five samples around it.
double extreme(const std::vector<double>& f, double sign) {
  const int n = static_cast<int>(f.size());
  int best = 0;
  for (int k = 0; k < n; ++k)
    if (sign * f[k] > sign * f[best]) best = k;
  const int first = std::clamp(best - 2, 0, n - 5);
  double largest = -1;
  for (int q = 0; q <= 4000; ++q) {
    const double x = q / 1000.0;
    double sum = 0;
    for (int i = 0; i < 5; ++i) {
      double share = f[first + i];
      for (int j = 0; j < 5; ++j)
        if (j != i) share *= (x - j) / (i - j);
      sum += share;
    }
    largest = std::max(largest, sign * sum);
  }
  return sign * largest;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 1;
  Cavity cavity{std::atoi(argv[1]), std::atof(argv[2]), std::atoi(argv[3]) != 0};
  for (int k = 0; k < 9 * cavity.n * cavity.n; ++k) cavity.f[k] = weight[k % 9];
  const auto steps = static_cast<long>(50.0 * cavity.n / cavity.speed);
  for (long s = 0; s < steps; ++s) cavity.step();
  std::vector<double> along, across;
  for (int k = 0; k < cavity.n; ++k) {
    along.push_back(cavity.velocity(cavity.n / 2, k, cx));
    across.push_back(cavity.velocity(k, cavity.n / 2, cz));
  }
  std::printf("%d cells: %.6f %.6f %.6f\n", cavity.n, extreme(along, -1), extreme(across, 1), extreme(across, -1));
}
