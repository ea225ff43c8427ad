#include "bodies/refill.hpp"

#include "bodies/map/lattice_vectors.hpp"
#include "core/base/check.hpp"
#include "core/parallel/mpi_session.hpp"
#include "lbm/lattice/equilibrium.hpp"

#include <algorithm>
#include <map>

namespace thalweg::bodies {

using lbm::CellMap;
using lbm::D3Q19;

namespace {

Index3 step_from(const Index3& cell, int direction) {
  return {cell[0] + D3Q19::c[direction][0], cell[1] + D3Q19::c[direction][1], cell[2] + D3Q19::c[direction][2]};
}

std::array<int, 3> key(const Index3& cell) { return {cell[2], cell[1], cell[0]}; }

}  // namespace

Refill::Refill(const Decomposition& decomposition, MPI_Comm communicator)
    : decomposition_(decomposition),
      communicator_(communicator),
      rank_(rank_of(communicator)),
      block_(decomposition.block_of(rank_)),
      box_(decomposition.cell_box()) {}

void Refill::Neighbours::add(const Neighbours& others) {
  count += others.count;
  excess += others.excess;
}

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

std::ptrdiff_t Refill::index_of(const lbm::CellIndexing& indexing, const Index3& global) const {
  return indexing.index(global[0] - block_.lower[0], global[1] - block_.lower[1], global[2] - block_.lower[2]);
}

// Every uncovered cell in reach once, sorted by place in the box, so that all ranks list shared cells in the same
// order.
std::vector<Refill::Uncovered> Refill::uncovered_cells(const std::vector<CellChange>& changes) const {
  std::vector<Uncovered> uncovered;
  for (const CellChange& change : changes) {
    if (change.now != CellMap::fluid) continue;
    Index3 global;
    for (int a = 0; a < 3; ++a) global[a] = block_.lower[a] + change.cell[a];
    uncovered.push_back({wrapped(global), change.before, {}});
  }
  std::sort(uncovered.begin(), uncovered.end(),
            [](const auto& a, const auto& b) { return key(a.global) < key(b.global); });
  const auto same = [](const Uncovered& a, const Uncovered& b) { return a.global == b.global; };
  uncovered.erase(std::unique(uncovered.begin(), uncovered.end(), same), uncovered.end());
  return uncovered;
}

template <typename Real>
void Refill::add_own_neighbours(const lbm::Fluid<Real>& fluid, const Hydrostatic& rest,
                                std::vector<Uncovered>& uncovered) const {
  const auto fresh = [&](const Index3& global) {
    const auto found = std::lower_bound(uncovered.begin(), uncovered.end(), key(global),
                                        [](const Uncovered& u, const auto& k) { return key(u.global) < k; });
    return found != uncovered.end() && found->global == global;
  };
  for (Uncovered& cell : uncovered)
    for (int i = 1; i < D3Q19::directions; ++i) {
      const Index3 neighbour = wrapped(step_from(cell.global, i));
      if (!block_.contains(neighbour)) continue;
      const std::ptrdiff_t at = index_of(fluid.indexing(), neighbour);
      if (!fluid.cells().is_fluid(at) || fresh(neighbour)) continue;
      const double excess = fluid.populations().density_deviation(at) - rest.deviation(centre_of(neighbour));
      cell.neighbours.add({1, LatticeFixed::from(excess)});
    }
}

void Refill::exchange(std::vector<Uncovered>& uncovered) const {
  std::map<int, std::vector<Neighbours>> outgoing, incoming;
  std::map<int, std::vector<std::size_t>> expected;
  for (std::size_t k = 0; k < uncovered.size(); ++k) {
    const Uncovered& cell = uncovered[k];
    if (block_.contains(cell.global)) {
      for (const int owner : owners_of_neighbours(cell.global)) expected[owner].push_back(k);
    } else {
      bool mine = false;
      for (int i = 1; i < D3Q19::directions; ++i) mine = mine || block_.contains(wrapped(step_from(cell.global, i)));
      if (mine) outgoing[owner_of(cell.global)].push_back(cell.neighbours);
    }
  }
  if (outgoing.empty() && expected.empty()) return;
  constexpr int tag = 17;
  std::vector<MPI_Request> requests;
  const auto bytes = [](const std::vector<Neighbours>& cells) {
    return static_cast<int>(sizeof(Neighbours) * cells.size());
  };
  for (auto& [from, cells] : expected) {
    incoming[from].resize(cells.size());
    requests.emplace_back();
    MPI_Irecv(incoming[from].data(), bytes(incoming[from]), MPI_BYTE, from, tag, communicator_, &requests.back());
  }
  for (auto& [to, cells] : outgoing) {
    requests.emplace_back();
    MPI_Isend(cells.data(), bytes(cells), MPI_BYTE, to, tag, communicator_, &requests.back());
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  for (auto& [from, cells] : expected)
    for (std::size_t k = 0; k < cells.size(); ++k) uncovered[cells[k]].neighbours.add(incoming[from][k]);
}

double Refill::excess_of(const Neighbours& n, double surrounding) {
  return n.count > 0 ? LatticeFixed::to_double(n.excess) / static_cast<double>(n.count) : surrounding;
}

// deviation: rho - 1.
std::array<double, 19> Refill::populations_of(double deviation, const Vec3& velocity, const Vec3& force) {
  std::array<double, 19> f;
  for (int i = 0; i < D3Q19::directions; ++i) {
    f[i] = lbm::equilibrium_deviation(i, deviation, velocity);
    f[i] += 1.5 * D3Q19::weight(i) * velocity_of(i).dot(force);
  }
  return f;
}

template <typename Real>
RefillTotals Refill::fill(lbm::Fluid<Real>& fluid, const std::vector<CellChange>& changes, const Hydrostatic& rest,
                          std::span<const double> surrounding, std::vector<LinkBody>& bodies) {
  RefillTotals totals;
  std::vector<Uncovered> uncovered = uncovered_cells(changes);
  if (uncovered.empty()) return totals;
  add_own_neighbours(fluid, rest, uncovered);
  exchange(uncovered);

  const Vec3& force = fluid.carried_force();
  for (const Uncovered& cell : uncovered) {
    if (!block_.contains(cell.global)) continue;
    CHECK(cell.before >= 0 && static_cast<std::size_t>(cell.before) < bodies.size());
    LinkBody& body = bodies[cell.before];
    const Vec3 position = centre_of(cell.global);
    const Vec3 velocity = body.velocity + body.angular_velocity.cross(box_.difference(position, body.centre));
    const double at_rest = rest.deviation(position);
    const double excess = excess_of(cell.neighbours, surrounding[static_cast<std::size_t>(cell.before)]);
    const std::array<double, 19> values = populations_of(at_rest + excess, velocity, force);
    const std::ptrdiff_t at = index_of(fluid.indexing(), cell.global);
    Vec3 momentum = Vec3::Zero();
    for (int i = 0; i < D3Q19::directions; ++i) {
      const Real value = static_cast<Real>(values[i]);
      fluid.populations().post_collision(i, at) = value;
      momentum += static_cast<double>(value) * velocity_of(i);
    }
    const std::int64_t brought = LatticeFixed::from(fluid.populations().density_deviation(at) - at_rest);
    body.mass += brought;
    totals.mass += brought;
    totals.momentum += momentum;
    totals.angular_momentum += position.cross(momentum);
    ++totals.cells;
  }
  return totals;
}

template RefillTotals Refill::fill(lbm::Fluid<float>&, const std::vector<CellChange>&, const Hydrostatic&,
                                   std::span<const double>, std::vector<LinkBody>&);
template RefillTotals Refill::fill(lbm::Fluid<double>&, const std::vector<CellChange>&, const Hydrostatic&,
                                   std::span<const double>, std::vector<LinkBody>&);

}  // namespace thalweg::bodies
