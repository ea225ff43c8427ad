#include "lbm/bouzidi.hpp"

#include "lbm/equilibrium.hpp"

namespace thalweg::lbm {

namespace {

// Base pointers by direction to what a link reads and writes; the index of x_f is added.
template <typename Real>
struct LinkSlots {
  const Real* into_body[D3Q19::directions];   // f_i^c(x_f)
  const Real* away[D3Q19::directions];        // f_i'^c(x_f)
  const Real* upstream[D3Q19::directions];    // f_i^c(x_ff)
  Real* reflected[D3Q19::directions];         // where the sweep will look for f_i'(x_f)
  const Real* all[D3Q19::directions];         // f_k^c(x_f) for every k

  explicit LinkSlots(Populations<Real>& populations) {
    for (int i = 0; i < D3Q19::directions; ++i) {
      const int opposite = D3Q19::opposite(i);
      into_body[i] = &populations.post_collision(i, 0);
      away[i] = &populations.post_collision(opposite, 0);
      upstream[i] = &populations.incoming(i, 0);   // also what a wall returned, if x_ff lies beyond one
      reflected[i] = &populations.incoming(opposite, 0);
      all[i] = into_body[i];
    }
  }

  double density_deviation(std::ptrdiff_t cell) const {
    double sum = 0.0;
    for (int i = 0; i < D3Q19::directions; ++i) sum += static_cast<double>(all[i][cell]);
    return sum;
  }
};

template <typename Real>
class ChunkPass {
public:
  ChunkPass(Populations<Real>& populations, const CellMap& cells, const PeriodicBox& box, const LinkOptions& options,
            std::vector<LinkBody>& bodies)
      : slots_(populations), cells_(cells), box_(box), options_(options), bodies_(bodies) {}

  void operator()(LinkBody& body, const Link* links, std::uint32_t count) {
    const Vec3 to_origin(body.origin[0] + 0.5 - body.centre.x(), body.origin[1] + 0.5 - body.centre.y(),
                         body.origin[2] + 0.5 - body.centre.z());
    FixedVec3 force, torque;
    for (std::uint32_t k = 0; k < count; ++k) {
      const Link& link = links[k];
      const int i = link.direction;
      const double delta = link.distance;
      const Vec3 c(D3Q19::c[i][0], D3Q19::c[i][1], D3Q19::c[i][2]);
      const Vec3 arm(to_origin.x() + link.offset[0] + delta * c.x(), to_origin.y() + link.offset[1] + delta * c.y(),
                     to_origin.z() + link.offset[2] + delta * c.z());
      const Vec3 wall_velocity = body.velocity + body.angular_velocity.cross(arm);
      const double towards_wall = c.dot(wall_velocity);
      const double weight = D3Q19::weight(i);
      const double density = options_.wall_density == WallDensity::local ? 1.0 + density_at(link.cell) : 1.0;

      const double incident = slots_.into_body[i][link.cell];
      double reflected;
      if (delta < 0.5) {
        const double upstream = link.upstream_solid ? covered_upstream(body, link)
                                                    : static_cast<double>(slots_.upstream[i][link.cell]);
        reflected = 2.0 * delta * incident + (1.0 - 2.0 * delta) * upstream - 6.0 * weight * density * towards_wall;
      } else {
        const double share = 0.5 / delta;
        const double away = slots_.away[i][link.cell];
        reflected = share * incident + (1.0 - share) * away - 6.0 * share * weight * density * towards_wall;
      }
      const Real stored = static_cast<Real>(reflected);
      slots_.reflected[i][link.cell] = stored;

      const double sum = incident + stored, difference = incident - stored;
      Vec3 momentum = sum * c;
      if (options_.momentum_exchange == MomentumExchange::galilean_invariant) momentum -= difference * wall_velocity;
      const Vec3 moment = arm.cross(momentum);
      force.add(momentum.x(), momentum.y(), momentum.z());
      torque.add(moment.x(), moment.y(), moment.z());
    }
    body.force += force;
    body.torque += torque;
  }

private:
  // rho - 1 at x_f; links of one cell follow one another, so it is summed once a cell. Links never change it: they write
  // incoming slots of fluid cells, which hold no post-collision population of a fluid cell.
  double density_at(std::uint32_t cell) {
    if (cell != last_cell_) {
      last_cell_ = cell;
      last_density_ = slots_.density_deviation(cell);
    }
    return last_density_;
  }

  double covered_upstream(const LinkBody& body, const Link& link) {
    const int i = link.direction;
    const std::ptrdiff_t upstream = static_cast<std::ptrdiff_t>(link.cell) - cells_.indexing().offset(i);
    const LinkBody& other = bodies_[cells_.body(upstream)];
    Vec3 position;
    for (int a = 0; a < 3; ++a) position[a] = body.origin[a] + link.offset[a] - D3Q19::c[i][a] + 0.5;
    const Vec3 velocity = other.velocity + other.angular_velocity.cross(box_.difference(position, other.centre));
    return equilibrium_deviation(i, density_at(link.cell), velocity);
  }

  LinkSlots<Real> slots_;
  const CellMap& cells_;
  const PeriodicBox& box_;
  const LinkOptions& options_;
  std::vector<LinkBody>& bodies_;
  std::uint32_t last_cell_ = 0xffffffffu;
  double last_density_ = 0.0;
};

}  // namespace

template <typename Real>
void apply_links(Populations<Real>& populations, const CellMap& cells, const LinkTable& links, const PeriodicBox& box,
                 const LinkOptions& options, std::vector<LinkBody>& bodies) {
  ChunkPass<Real> pass(populations, cells, box, options, bodies);
  for (const LinkTable::Plane& plane : links.planes())
    for (const LinkTable::Chunk& chunk : plane.chunks)
      if (chunk.count > 0) pass(bodies[chunk.body], plane.links.data() + chunk.first, chunk.count);
}

template void apply_links(Populations<float>&, const CellMap&, const LinkTable&, const PeriodicBox&, const LinkOptions&,
                          std::vector<LinkBody>&);
template void apply_links(Populations<double>&, const CellMap&, const LinkTable&, const PeriodicBox&,
                          const LinkOptions&, std::vector<LinkBody>&);

}  // namespace thalweg::lbm
