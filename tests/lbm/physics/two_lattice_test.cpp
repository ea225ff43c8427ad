// The whole step, walls and corners included, against the method as textbooks write it: two lattices, full populations,
// collide everywhere, then stream everywhere, link by link, with half-way bounce-back.
#include "lbm/fluid/fluid.hpp"

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <vector>

namespace thalweg::lbm::two_lattice_test {
namespace {

struct Moments {
  double density = 0.0;
  Vec3 velocity = Vec3::Zero();
};

class TwoLattices {
public:
  TwoLattices(const Index3& cells, const CollisionParameters& parameters, const Vec3& lid_velocity)
      : n_(cells), p_(parameters), force_(p_.force[0], p_.force[1], p_.force[2]), lid_(lid_velocity) {
    collided_.resize(static_cast<std::size_t>(n_[0]) * n_[1] * n_[2]);
    for (auto& f : collided_)
      for (int i = 0; i < 19; ++i) f[i] = D3Q19::weight(i);
    streamed_ = collided_;
  }

  void step() {
    stream();
    for (std::size_t cell = 0; cell < collided_.size(); ++cell) collided_[cell] = collide(streamed_[cell]);
  }

  // Velocity of the populations after the collision: that half-way through it.
  Vec3 velocity(int x, int y, int z) const {
    const auto& f = collided_[index(x, y, z)];
    const Moments m = sums(f);
    return m.velocity - 0.5 * force_ / m.density;
  }

private:
  using Cell = std::array<double, 19>;

  std::size_t index(int x, int y, int z) const { return (static_cast<std::size_t>(z) * n_[1] + y) * n_[0] + x; }
  static Vec3 c(int i) { return Vec3(D3Q19::c[i][0], D3Q19::c[i][1], D3Q19::c[i][2]); }

  static Moments sums(const Cell& f) {
    Moments m;
    for (int i = 0; i < 19; ++i) {
      m.density += f[i];
      m.velocity += f[i] * c(i);
    }
    m.velocity /= m.density;
    return m;
  }

  Cell collide(const Cell& f) const {
    Moments m = sums(f);
    m.velocity += 0.5 * force_ / m.density;
    const Vec3& u = m.velocity;
    Cell equilibrium, guo;
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    for (int i = 0; i < 19; ++i) {
      const double cu = c(i).dot(u), w = D3Q19::weight(i);
      equilibrium[i] = w * m.density * (1.0 + 3.0 * cu + 4.5 * cu * cu - 1.5 * u.squaredNorm());
      guo[i] = w * (3.0 * (c(i) - u).dot(force_) + 9.0 * cu * c(i).dot(force_));
      moment += (f[i] - equilibrium[i]) * c(i) * c(i).transpose();
    }
    const Eigen::Matrix3d pi = moment + 0.5 * (u * force_.transpose() + force_ * u.transpose());
    const bool bulk = p_.bulk_relaxation_time > 0.0;
    const double tau = relaxation_time(pi, m.density);
    // No body is near, so that trt_at_bodies is bgk.
    const double odd_tau = p_.model == CollisionModel::trt ? 0.5 + p_.magic_parameter / (tau - 0.5) : tau;
    Cell after;
    for (int i = 0; i < 19; ++i) {
      const int o = D3Q19::opposite(i);
      const double excess = f[i] - equilibrium[i], opposite = f[o] - equilibrium[o];
      after[i] = f[i] - 0.5 * (excess + opposite) / tau - 0.5 * (excess - opposite) / odd_tau +
                 (1.0 - 0.5 / tau) * 0.5 * (guo[i] + guo[o]) + (1.0 - 0.5 / odd_tau) * 0.5 * (guo[i] - guo[o]);
      if (bulk) after[i] += change_of_trace(i, moment.trace(), 2.0 * u.dot(force_), tau);
    }
    return after;
  }

  // tau = tau_0 + 3 nu_t, solved for tau.
  double relaxation_time(const Eigen::Matrix3d& pi, double density) const {
    const Eigen::Matrix3d traceless = pi - pi.trace() / 3.0 * Eigen::Matrix3d::Identity();
    const double tau0 = p_.relaxation_time, constant = p_.subgrid.constant();
    const auto with = [&](double eddies) { return 0.5 * (tau0 + std::sqrt(tau0 * tau0 + eddies / density)); };
    switch (p_.subgrid.model()) {
      case SubgridModel::none:
        return tau0;
      case SubgridModel::smagorinsky:
        return with(18.0 * std::sqrt(2.0) * constant * constant *
                    (p_.bulk_relaxation_time > 0.0 ? traceless : pi).norm());
      case SubgridModel::qr: {
        const double squares = traceless.squaredNorm();
        return squares > 0.0 ? with(36.0 * constant * std::max(0.0, traceless.determinant()) / squares) : tau0;
      }
    }
    return tau0;
  }

  // The part of a population that its second moment's trace makes up, w_i (3/2)(c_i.c_i - 1) times the trace, and the
  // same part of Guo's force: relaxed with tau_b instead of tau.
  double change_of_trace(int i, double of_excess, double of_guo, double tau) const {
    const double part = 1.5 * D3Q19::weight(i) * (c(i).squaredNorm() - 1.0), tau_b = p_.bulk_relaxation_time;
    const auto relaxed = [&](double time) { return (1.0 - 1.0 / time) * of_excess + (1.0 - 0.5 / time) * of_guo; };
    return part * (relaxed(tau_b) - relaxed(tau));
  }

  void stream() {
    for (int z = 0; z < n_[2]; ++z)
      for (int y = 0; y < n_[1]; ++y)
        for (int x = 0; x < n_[0]; ++x)
          for (int i = 0; i < 19; ++i) {
            const Cell& f = collided_[index(x, y, z)];
            const int to[3] = {x + D3Q19::c[i][0], y + D3Q19::c[i][1], z + D3Q19::c[i][2]};
            bool leaves = false;
            for (int a = 0; a < 3; ++a) leaves = leaves || to[a] < 0 || to[a] >= n_[a];
            if (!leaves) {
              streamed_[index(to[0], to[1], to[2])][i] = f[i];
            } else {
              const double carried = to[2] >= n_[2] ? 6.0 * D3Q19::weight(i) * sums(f).density * c(i).dot(lid_) : 0.0;
              streamed_[index(x, y, z)][D3Q19::opposite(i)] = f[i] - carried;
            }
          }
  }

  Index3 n_;
  CollisionParameters p_;
  Vec3 force_, lid_;
  std::vector<Cell> collided_, streamed_;
};

// A lid slides slantwise over a box and a force pushes the fluid, with and without eddies; walls, edges and corners
// all take part from the first steps; with bulk viscosities of their own, too. The two differ by the rounding of
// populations, 1e-16 a step, amplified by what the flow itself amplifies: nothing much in 60 steps at these Reynolds
// numbers (20 and less).
TEST(Fluid, IsTheTextbookMethodCellByCell) {
  const Index3 cells{7, 6, 9};
  const Vec3 lid(0.05, 0.02, 0.0);
  const Subgrid none = Subgrid::none(), smagorinsky = Subgrid::smagorinsky(0.2), qr = Subgrid::qr();
  for (const CollisionModel model : {CollisionModel::bgk, CollisionModel::trt, CollisionModel::trt_at_bodies})
    for (const auto& [subgrid, bulk] :
         {std::pair(none, 0.0), {smagorinsky, 0.0}, {qr, 0.0}, {none, 10.0}, {smagorinsky, 3.0}, {qr, 3.0}}) {
      CollisionParameters parameters;
      parameters.bulk_relaxation_time = bulk;
      parameters.model = model;
      parameters.relaxation_time = 0.56;
      parameters.subgrid = subgrid;
      parameters.force[1] = 3e-5;
      parameters.force[2] = -1e-5;
      FaceConditions faces;
      for (FaceCondition& face : faces) face.type = FaceType::no_slip;
      faces[5].type = FaceType::moving;
      faces[5].velocity = lid;
      const Decomposition decomposition(cells, 1.0, {false, false, false}, {1, 1, 1});
      Fluid<double> fluid(decomposition, MPI_COMM_SELF, parameters, faces);
      TwoLattices textbook(cells, parameters, lid);
      for (int step = 0; step < 60; ++step) {
        fluid.advance();
        textbook.step();
      }
      double largest = 0.0, fastest = 0.0;
      for (int z = 0; z < cells[2]; ++z)
        for (int y = 0; y < cells[1]; ++y)
          for (int x = 0; x < cells[0]; ++x) {
            const Vec3 u = textbook.velocity(x, y, z);
            largest = std::max(largest, (fluid.state_at(fluid.indexing().index(x, y, z)).velocity - u).norm());
            fastest = std::max(fastest, u.norm());
          }
      EXPECT_LT(largest, 1e-13) << "collision " << int(model) << ", subgrid model " << int(subgrid.model())
                                << ", tau_b " << bulk;
      EXPECT_GT(fastest, 0.01);  // there is a flow to compare
    }
}

}  // namespace
}  // namespace thalweg::lbm::two_lattice_test
