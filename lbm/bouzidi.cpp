#include "lbm/bouzidi.hpp"

#include "lbm/equilibrium.hpp"

#include <algorithm>

namespace thalweg::lbm {

namespace {

// Base pointers by direction to what a link reads and writes; the index of x_f is added.
template <typename Real>
struct LinkSlots {
  const Real* into_body[D3Q19::directions];  // f_i^c(x_f)
  const Real* second[2][D3Q19::directions];  // f_i'^c(x_f) for the far half of the link, f_i^c(x_ff) for the near half
  Real* reflected[D3Q19::directions];        // where the sweep will look for f_i'(x_f)

  explicit LinkSlots(Populations<Real>& populations) {
    for (int i = 0; i < D3Q19::directions; ++i) {
      const int opposite = D3Q19::opposite(i);
      into_body[i] = &populations.post_collision(i, 0);
      second[0][i] = &populations.post_collision(opposite, 0);
      second[1][i] = &populations.incoming(i, 0);  // also what a wall returned, if x_ff lies beyond one
      reflected[i] = &populations.incoming(opposite, 0);
    }
  }
};

// Links of one body on their way through the arithmetic, as arrays the compiler can vectorise over.
struct Batch {
  static constexpr int capacity = 128;
  alignas(64) double delta[capacity], weight[capacity], density[capacity];
  alignas(64) double cx[capacity], cy[capacity], cz[capacity];  // c_i
  alignas(64) double ax[capacity], ay[capacity], az[capacity];  // x_f from the body's centre; then the arm
  alignas(64) double incident[capacity], second[capacity];      // f_i^c(x_f); f_i^c(x_ff) or f_i'^c(x_f)
  alignas(64) double reflected[capacity];
  std::uint32_t cells[capacity];  // distinct fluid cells, in order
  int cell_of[capacity];          // index into cells
};

struct DirectionTable {
  double c[3][D3Q19::directions], weight[D3Q19::directions];
  constexpr DirectionTable() : c(), weight() {
    for (int i = 0; i < D3Q19::directions; ++i) {
      for (int a = 0; a < 3; ++a) c[a][i] = D3Q19::c[i][a];
      weight[i] = D3Q19::weight(i);
    }
  }
};
constexpr DirectionTable directions;

template <typename Real>
class LinkPass {
public:
  LinkPass(Populations<Real>& populations, const CellMap& cells, const PeriodicBox& box, const LinkOptions& options,
           std::vector<LinkBody>& bodies)
      : slots_(populations), cells_(cells), box_(box), options_(options), bodies_(bodies) {}

  // links_end: end of the plane's records, valid to look ahead to.
  void operator()(LinkBody& body, const Link* links, int count, const Link* links_end) {
    for (int first = 0; first < count; first += Batch::capacity) {
      const int n = std::min(Batch::capacity, count - first);
      ask_for(links + first, n, links_end);
      gather(body, links + first, n);
      reflect(body, n);
      scatter(links + first, n);
      exchange(body, n);
    }
  }

private:
  // Asks the memory for what a later batch will need; the lines of the links between are on their way already.
  void ask_for(const Link* links, int n, const Link* links_end) const {
    const Link* first = links + lookahead;
    const Link* last = std::min(first + n, links_end);
    for (const Link* link = first; link < last; ++link) {
      const int i = link->direction;
      __builtin_prefetch(slots_.into_body[i] + link->cell, 0);
      __builtin_prefetch(slots_.second[link->distance < 0.5f][i] + link->cell, 0);
      __builtin_prefetch(slots_.reflected[i] + link->cell, 1);
    }
  }

  void gather(const LinkBody& body, const Link* links, int n) {
    Batch& b = batch_;
    const double to_origin[3] = {body.origin[0] + 0.5 - body.centre.x(), body.origin[1] + 0.5 - body.centre.y(),
                                 body.origin[2] + 0.5 - body.centre.z()};
    int distinct = 0;
    for (int k = 0; k < n; ++k) {
      const Link& link = links[k];
      const int i = link.direction;
      if (distinct == 0 || b.cells[distinct - 1] != link.cell) b.cells[distinct++] = link.cell;
      b.cell_of[k] = distinct - 1;
      b.delta[k] = link.distance;
      b.weight[k] = directions.weight[i];
      b.cx[k] = directions.c[0][i];
      b.cy[k] = directions.c[1][i];
      b.cz[k] = directions.c[2][i];
      b.ax[k] = to_origin[0] + link.offset[0];
      b.ay[k] = to_origin[1] + link.offset[1];
      b.az[k] = to_origin[2] + link.offset[2];
      b.incident[k] = slots_.into_body[i][link.cell];
      b.second[k] = slots_.second[link.distance < 0.5f][i][link.cell];
    }
    densities(n, distinct);
    for (int k = 0; k < n; ++k)
      if (links[k].upstream_solid && links[k].distance < 0.5f)
        b.second[k] = covered_upstream(body, links[k], local_density_[b.cell_of[k]]);
  }

  // rho at the fluid cells of the batch. Links never change it: they write incoming slots of fluid cells, which hold no
  // post-collision population of a fluid cell.
  void densities(int n, int distinct) {
    for (int d = 0; d < distinct; ++d) local_density_[d] = 0.0;
    for (int i = 0; i < D3Q19::directions; ++i)
      for (int d = 0; d < distinct; ++d) local_density_[d] += static_cast<double>(slots_.into_body[i][batch_.cells[d]]);
    const bool local = options_.wall_density == WallDensity::local;
    for (int k = 0; k < n; ++k) batch_.density[k] = local ? 1.0 + local_density_[batch_.cell_of[k]] : 1.0;
  }

  double covered_upstream(const LinkBody& body, const Link& link, double density_deviation) const {
    const int i = link.direction;
    const std::ptrdiff_t upstream = static_cast<std::ptrdiff_t>(link.cell) - cells_.indexing().offset(i);
    const LinkBody& other = bodies_[cells_.body(upstream)];
    Vec3 position;
    for (int a = 0; a < 3; ++a) position[a] = body.origin[a] + link.offset[a] - D3Q19::c[i][a] + 0.5;
    const Vec3 velocity = other.velocity + other.angular_velocity.cross(box_.difference(position, other.centre));
    return equilibrium_deviation(i, density_deviation, velocity);
  }

  void reflect(const LinkBody& body, int n) {
    Batch& b = batch_;
    const double vx = body.velocity.x(), vy = body.velocity.y(), vz = body.velocity.z();
    const double wx = body.angular_velocity.x(), wy = body.angular_velocity.y(), wz = body.angular_velocity.z();
    for (int k = 0; k < n; ++k) {
      const double delta = b.delta[k];
      b.ax[k] += delta * b.cx[k];
      b.ay[k] += delta * b.cy[k];
      b.az[k] += delta * b.cz[k];
      const double towards_wall = b.cx[k] * (vx + wy * b.az[k] - wz * b.ay[k]) +
                                  b.cy[k] * (vy + wz * b.ax[k] - wx * b.az[k]) +
                                  b.cz[k] * (vz + wx * b.ay[k] - wy * b.ax[k]);
      const double share = delta < 0.5 ? 2.0 * delta : 0.5 / delta;
      const double wall_factor = delta < 0.5 ? 6.0 : 6.0 * share;
      b.reflected[k] =
          share * b.incident[k] + (1.0 - share) * b.second[k] - wall_factor * b.weight[k] * b.density[k] * towards_wall;
    }
  }

  // Stores the populations and keeps what the store rounded them to: the momentum must be that of what streams.
  void scatter(const Link* links, int n) {
    for (int k = 0; k < n; ++k) {
      const Real stored = static_cast<Real>(batch_.reflected[k]);
      slots_.reflected[links[k].direction][links[k].cell] = stored;
      batch_.reflected[k] = stored;
    }
  }

  void exchange(LinkBody& body, int n) {
    const Batch& b = batch_;
    const double vx = body.velocity.x(), vy = body.velocity.y(), vz = body.velocity.z();
    const double wx = body.angular_velocity.x(), wy = body.angular_velocity.y(), wz = body.angular_velocity.z();
    const double galilean = options_.momentum_exchange == MomentumExchange::galilean_invariant ? 1.0 : 0.0;
    FixedVec3 force, torque;
    for (int k = 0; k < n; ++k) {
      const double sum = b.incident[k] + b.reflected[k], flux = galilean * (b.incident[k] - b.reflected[k]);
      const double mx = sum * b.cx[k] - flux * (vx + wy * b.az[k] - wz * b.ay[k]);
      const double my = sum * b.cy[k] - flux * (vy + wz * b.ax[k] - wx * b.az[k]);
      const double mz = sum * b.cz[k] - flux * (vz + wx * b.ay[k] - wy * b.ax[k]);
      force.x += LatticeFixed::from(mx);
      force.y += LatticeFixed::from(my);
      force.z += LatticeFixed::from(mz);
      torque.x += LatticeFixed::from(b.ay[k] * mz - b.az[k] * my);
      torque.y += LatticeFixed::from(b.az[k] * mx - b.ax[k] * mz);
      torque.z += LatticeFixed::from(b.ax[k] * my - b.ay[k] * mx);
    }
    body.force += force;
    body.torque += torque;
  }

  static constexpr int lookahead = 128;  // links

  LinkSlots<Real> slots_;
  const CellMap& cells_;
  const PeriodicBox& box_;
  const LinkOptions& options_;
  std::vector<LinkBody>& bodies_;
  Batch batch_;
  double local_density_[Batch::capacity];  // rho - 1 of the batch's distinct cells
};

}  // namespace

template <typename Real>
void apply_links(Populations<Real>& populations, const CellMap& cells, const LinkTable& links, const PeriodicBox& box,
                 const LinkOptions& options, std::vector<LinkBody>& bodies) {
  LinkPass<Real> pass(populations, cells, box, options, bodies);
  for (int z = 0; z < static_cast<int>(links.planes().size()); ++z) {
    const LinkTable::Plane& plane = links.planes()[z];
    for (const std::uint32_t c : links.chunks_in_order(z)) {
      const LinkTable::Chunk& chunk = plane.chunks[c];
      pass(bodies[chunk.body], plane.links.data() + chunk.first, static_cast<int>(chunk.count),
           plane.links.data() + plane.links.size());
    }
  }
}

template void apply_links(Populations<float>&, const CellMap&, const LinkTable&, const PeriodicBox&, const LinkOptions&,
                          std::vector<LinkBody>&);
template void apply_links(Populations<double>&, const CellMap&, const LinkTable&, const PeriodicBox&,
                          const LinkOptions&, std::vector<LinkBody>&);

}  // namespace thalweg::lbm
