#include "coupling/refill.hpp"

#include "core/mpi_session.hpp"
#include "lbm/equilibrium.hpp"

#include <algorithm>
#include <map>

namespace thalweg::coupling {

using lbm::CellMap;
using lbm::D3Q19;

namespace {

Index3 step_from(const Index3& cell, int direction) {
  return {cell[0] + D3Q19::c[direction][0], cell[1] + D3Q19::c[direction][1], cell[2] + D3Q19::c[direction][2]};
}

}  // namespace

Refill::Refill(const Decomposition& decomposition, MPI_Comm communicator)
    : decomposition_(decomposition),
      communicator_(communicator),
      rank_(rank_of(communicator)),
      block_(decomposition.block_of(rank_)) {}

Index3 Refill::wrapped(Index3 cell) const {
  for (int a = 0; a < 3; ++a)
    if (decomposition_.periodic()[a]) {
      const int n = decomposition_.cells()[a];
      cell[a] = (cell[a] % n + n) % n;
    }
  return cell;
}

bool Refill::inside_box(const Index3& cell) const { return Block{{0, 0, 0}, decomposition_.cells()}.contains(cell); }

int Refill::owner_of(const Index3& cell) const {
  const double h = decomposition_.spacing();
  return decomposition_.owner_of(Vec3((cell[0] + 0.5) * h, (cell[1] + 0.5) * h, (cell[2] + 0.5) * h));
}

std::vector<int> Refill::owners_of_neighbours(const Index3& cell) const {
  std::vector<int> owners;
  for (int i = 1; i < D3Q19::directions; ++i) {
    const Index3 neighbour = wrapped(step_from(cell, i));
    if (inside_box(neighbour)) owners.push_back(owner_of(neighbour));
  }
  std::sort(owners.begin(), owners.end());
  owners.erase(std::unique(owners.begin(), owners.end()), owners.end());
  std::erase(owners, rank_);
  return owners;
}

// Every uncovered cell in reach once, sorted by place in the box, so that all ranks list shared cells in the same
// order.
std::vector<Refill::Uncovered> Refill::uncovered_cells(const std::vector<GrainMap::Change>& changes) const {
  std::vector<Uncovered> uncovered;
  for (const GrainMap::Change& change : changes) {
    if (change.now != CellMap::fluid) continue;
    Index3 global;
    for (int a = 0; a < 3; ++a) global[a] = block_.lower[a] + change.cell[a];
    uncovered.push_back({wrapped(global), change.cell, change.before, {}});
  }
  const auto key = [](const Uncovered& u) { return std::array<int, 3>{u.global[2], u.global[1], u.global[0]}; };
  std::sort(uncovered.begin(), uncovered.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  const auto same = [](const Uncovered& a, const Uncovered& b) { return a.global == b.global; };
  uncovered.erase(std::unique(uncovered.begin(), uncovered.end(), same), uncovered.end());
  return uncovered;
}

template <typename Real>
void Refill::add_own_neighbours(const lbm::Fluid<Real>& fluid, std::vector<Uncovered>& uncovered) const {
  const auto fresh = [&](const Index3& global) {
    const auto found =
        std::find_if(uncovered.begin(), uncovered.end(), [&](const auto& u) { return u.global == global; });
    return found != uncovered.end();
  };
  for (Uncovered& cell : uncovered)
    for (int i = 1; i < D3Q19::directions; ++i) {
      const Index3 neighbour = wrapped(step_from(cell.global, i));
      if (!block_.contains(neighbour)) continue;
      const std::ptrdiff_t at = fluid.indexing().index(neighbour[0] - block_.lower[0], neighbour[1] - block_.lower[1],
                                                       neighbour[2] - block_.lower[2]);
      if (!fluid.cells().is_fluid(at) || fresh(neighbour)) continue;
      cell.density.sum += LatticeFixed::from(fluid.populations().density_deviation(at));
      ++cell.density.count;
    }
}

void Refill::exchange_sums(std::vector<Uncovered>& uncovered) const {
  std::map<int, std::vector<DensitySum>> outgoing, incoming;
  std::map<int, std::vector<std::size_t>> expected;
  for (std::size_t k = 0; k < uncovered.size(); ++k) {
    const Uncovered& cell = uncovered[k];
    if (block_.contains(cell.global)) {
      for (const int owner : owners_of_neighbours(cell.global)) expected[owner].push_back(k);
    } else {
      bool mine = false;
      for (int i = 1; i < D3Q19::directions; ++i) mine = mine || block_.contains(wrapped(step_from(cell.global, i)));
      if (mine) outgoing[owner_of(cell.global)].push_back(cell.density);
    }
  }
  if (outgoing.empty() && expected.empty()) return;
  constexpr int tag = 17;
  std::vector<MPI_Request> requests;
  for (auto& [from, cells] : expected) {
    incoming[from].resize(cells.size());
    requests.emplace_back();
    MPI_Irecv(incoming[from].data(), static_cast<int>(2 * cells.size()), MPI_INT64_T, from, tag, communicator_,
              &requests.back());
  }
  for (auto& [to, sums] : outgoing) {
    requests.emplace_back();
    MPI_Isend(sums.data(), static_cast<int>(2 * sums.size()), MPI_INT64_T, to, tag, communicator_, &requests.back());
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  for (auto& [from, cells] : expected)
    for (std::size_t k = 0; k < cells.size(); ++k) {
      uncovered[cells[k]].density.sum += incoming[from][k].sum;
      uncovered[cells[k]].density.count += incoming[from][k].count;
    }
}

template <typename Real>
RefillTotals Refill::equilibrium(lbm::Fluid<Real>& fluid, const std::vector<GrainMap::Change>& changes,
                                 const std::vector<lbm::LinkBody>& bodies) {
  RefillTotals totals;
  std::vector<Uncovered> uncovered = uncovered_cells(changes);
  if (uncovered.empty()) return totals;
  add_own_neighbours(fluid, uncovered);
  exchange_sums(uncovered);

  const PeriodicBox box{Vec3(decomposition_.cells()[0], decomposition_.cells()[1], decomposition_.cells()[2]),
                        decomposition_.periodic()};
  for (const Uncovered& cell : uncovered) {
    if (!block_.contains(cell.global)) continue;
    const lbm::LinkBody& body = bodies[cell.before];
    const Vec3 position(cell.global[0] + 0.5, cell.global[1] + 0.5, cell.global[2] + 0.5);
    const Vec3 velocity = body.velocity + body.angular_velocity.cross(box.difference(position, body.centre));
    const double density = cell.density.count > 0
                               ? LatticeFixed::to_double(cell.density.sum) / static_cast<double>(cell.density.count)
                               : 0.0;
    const std::ptrdiff_t at = fluid.indexing().index(cell.global[0] - block_.lower[0], cell.global[1] - block_.lower[1],
                                                     cell.global[2] - block_.lower[2]);
    for (int i = 0; i < D3Q19::directions; ++i) {
      const Real value = static_cast<Real>(lbm::equilibrium_deviation(i, density, velocity));
      fluid.populations().post_collision(i, at) = value;
      for (int a = 0; a < 3; ++a) totals.momentum[a] += D3Q19::c[i][a] * static_cast<double>(value);
    }
    ++totals.cells;
  }
  return totals;
}

template RefillTotals Refill::equilibrium(lbm::Fluid<float>&, const std::vector<GrainMap::Change>&,
                                          const std::vector<lbm::LinkBody>&);
template RefillTotals Refill::equilibrium(lbm::Fluid<double>&, const std::vector<GrainMap::Change>&,
                                          const std::vector<lbm::LinkBody>&);

}  // namespace thalweg::coupling
