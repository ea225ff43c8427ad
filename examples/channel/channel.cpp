// Plane channel flow with the lattice library alone: between two walls a body force drives a parabola,
//
//   u(z) = F/(2 nu) z (h - z),
//
// which trt meets to round-off once the flow is steady. Runs on any number of MPI ranks. Lattice units.
#include "core/parallel/mpi_session.hpp"
#include "lbm/fluid/fluid.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace thalweg;

int main(int argc, char** argv) {
  MpiSession session(argc, argv);
  const Index3 cells{8, 8, 32};
  const Decomposition decomposition(cells, 1.0, {true, true, false},
                                    Decomposition::best_layout(cells, size_of(MPI_COMM_WORLD)));
  lbm::CollisionParameters collision;
  collision.model = lbm::CollisionModel::trt;
  collision.relaxation_time = 1.0;
  collision.force[0] = 1e-6;
  lbm::FaceConditions faces;
  for (const bool upper : {false, true}) faces[lbm::face_of(2, upper)].type = lbm::FaceType::no_slip;

  lbm::Fluid<double> fluid(decomposition, MPI_COMM_WORLD, collision, faces);
  fluid.initialise([](const Vec3&) { return lbm::FluidState{}; });
  for (int step = 0; step < 25000; ++step) fluid.advance();

  const double viscosity = (collision.relaxation_time - 0.5) / 3.0, height = cells[2];
  const Block& block = fluid.block();
  double largest = 0.0, error = 0.0;
  for (int k = 0; k < block.size()[2]; ++k) {
    const double z = block.lower[2] + k + 0.5, exact = 0.5 * collision.force[0] / viscosity * z * (height - z);
    const double found = fluid.state_at(fluid.indexing().index(0, 0, k)).velocity.x();
    error = std::max(error, std::abs(found - exact));
    largest = std::max(largest, exact);
  }
  error = max_over_ranks(MPI_COMM_WORLD, error) / max_over_ranks(MPI_COMM_WORLD, largest);
  if (rank_of(MPI_COMM_WORLD) == 0) std::printf("largest error %.1e of the largest velocity\n", error);
  return error < 1e-11 ? 0 : 1;
}
