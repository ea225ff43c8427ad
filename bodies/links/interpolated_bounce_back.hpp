// Interpolated bounce-back on moving bodies and the momentum it exchanges.
//
// A link runs from the fluid cell x_f along c_i into a body; i' is the opposite, delta the distance to the surface, f^c
// post-collision, x_ff = x_f - c_i, u_w the velocity of the surface where the link meets it. What comes back, f_i'(x_f,
// t+1), is given by a rule (link_rules.hpp).
// If x_ff is covered by a body, Bouzidi's rule takes for f_i^c(x_ff) the equilibrium at the density of x_f and that
// body's velocity at x_ff (Zhang et al. 2022; upstream_bodies.hpp); the other rule becomes half-way bounce-back. If it
// lies beyond a wall, the population that the wall returns to x_f stands in.
//
// Force on the body per step: the Galilean-invariant exchange of Wen et al. 2014, sum (c_i - u_w) f_i^c - (c_i' - u_w)
// f_i', or the classical one of Mei et al. 2002, sum c_i (f_i^c + f_i'). w_i times a reference density is subtracted
// from populations, so that touching bodies feel no false attraction from the cells they hide from each other.
//
// Mass: a link takes f_i^c and gives f_i', which differ. The surplus that a body's links have taken is returned in the
// next steps as w_i (a + b.c_i) on top of f_i', with LinkBody's a and b.
//
// Enclosed cells (enclosed_cells.hpp; near contacts, with ten or more cells a diameter one for a few hundred grains)
// pass nothing on, and any surplus or deficit from their links would add up without bound. Actual gaps around them, too
// narrow for the cells, would keep their pressure at that outside. Their links therefore take w_i (rho - rho_rest), two
// thirds of the excess in a step, and owe it like all else that they take.
#pragma once

#include "bodies/links/link_crossings.hpp"
#include "bodies/links/link_slots.hpp"
#include "bodies/links/momentum_by_height.hpp"
#include "bodies/links/tile_prefetch.hpp"
#include "bodies/links/upstream_bodies.hpp"
#include "bodies/map/body_options.hpp"
#include "bodies/map/link_table.hpp"
#include "core/geometry/periodic_box.hpp"
#include "lbm/fluid/fluid.hpp"

#include <array>
#include <cstddef>
#include <experimental/simd>
#include <vector>

namespace thalweg::bodies {

// Applies the links of one step, tile by tile. For every link it writes the population that the sweep will take from
// the solid side, and adds to the sums of bodies[...], which the caller has cleared (LinkBody::clear_sums()). Halo and
// walls must be up to date. The cell map holds indices into `bodies`. box: the domain in cells, for the minimum image
// between bodies. All of these must outlive the pass.
//
// The links of a row read what cells of the rows around it sent out, so they must be applied before any of these rows
// is swept; lbm::Fluid::stream_and_collide(before_tile) does so while the tile is still in the cache. Apply tiles in
// order.
//
// Links are processed in batches, each of several bodies: prepare() finds and prefetches what they read and write, and
// finish(), one batch later, does the exchange. Meanwhile the populations two planes ahead are prefetched.
//
// moments: where given, one for each body, to which sum F_a x_b is added but for the first `solids` of them, F the
// momentum of a link and x its arm; the torque is its antisymmetric part. (A solid as large as the box would leave the
// range of exact sums.) by_height: where given, the force of every link is added at the height half a link from its
// fluid cell.
template <typename Real>
class InterpolatedBounceBack {
public:
  InterpolatedBounceBack(lbm::Fluid<Real>& fluid, const LinkTable& links, const PeriodicBox& box,
                         const LinkOptions& options, std::vector<LinkBody>& bodies,
                         std::vector<FixedTensor>* moments = nullptr, int solids = 0,
                         MomentumByHeight* by_height = nullptr);

  void apply_tile(int tile);

private:
  static constexpr int capacity = UpstreamBodies::capacity;
  // Links of one body in a batch: [first, first + count), and copies of the last up to padded(count). The first
  // `narrow` of them have a body at x_ff.
  struct Piece {
    std::int32_t body;
    int first, count, narrow;

    int end() const { return first + count; }
    int filled_end() const { return first + padded(count); }
    int narrow_end() const { return first + narrow; }
  };
  struct Batch {
    int size = 0, plane = 0;  // size: with the copies
    int pieces = 0;
    Piece piece[capacity / links_at_a_time];
    std::int32_t body[capacity / links_at_a_time];  // of every links_at_a_time links
    bool leaks = false;                             // true if a link starts in an enclosed cell
    int narrow_count = 0;
    std::int32_t narrow[capacity];  // links whose second value comes from the body at x_ff
    alignas(64) std::uint32_t xy[capacity], tag[capacity];
    alignas(64) std::int32_t cell[capacity];  // index of x_f within its plane
    alignas(64) std::int32_t incident_at[capacity], second_at[capacity], reflected_at[capacity];  // LinkSlots
    alignas(64) Real distance[capacity], arm[3][capacity];

    void clear(int z) {
      plane = z;
      size = pieces = narrow_count = 0;
    }
  };
  // Input and results of a batch.
  struct Values {
    alignas(64) Real deviation[capacity];                   // rho - 1 at x_f
    alignas(64) Real excess[capacity];                      // rho - rho_rest at x_f, where it is not the same
    alignas(64) Real incident[capacity], second[capacity];  // f_i^c(x_f); the rule's other value
    alignas(64) Real leak[capacity];       // rho - rho_rest - reference density where x_f is enclosed, else 0
    alignas(64) Real reflected[capacity];  // f_i'(x_f, t+1)
    // Terms of the sums, zero for copies. taken, given: f_i^c(x_f), f_i'(x_f, t+1); pressure: w_i (rho -
    // rho_rest)(x_f).
    alignas(64) Real taken[capacity], given[capacity], pressure[capacity];
    alignas(64) Real momentum[3][capacity], torque[3][capacity];
    alignas(64) Real moment[3][3][capacity];
  };
  static int component(std::uint32_t tag, int axis) { return LinkTag::velocity(static_cast<int>(tag), axis); }

  using Wide = std::experimental::native_simd<double>;
  [[gnu::always_inline]] static Wide wide(const Real* values) {
    return Wide(values, std::experimental::element_aligned);
  }

  using Pack = std::experimental::native_simd<Real>;
  using Ints = std::experimental::rebind_simd_t<std::int32_t, Pack>;
  // A body's motion in every lane.
  struct Body {
    Pack vx, vy, vz, wx, wy, wz, returned, sx, sy, sz;

    explicit Body(const LinkBody& body)
        : vx(Real(body.velocity.x())),
          vy(Real(body.velocity.y())),
          vz(Real(body.velocity.z())),
          wx(Real(body.angular_velocity.x())),
          wy(Real(body.angular_velocity.y())),
          wz(Real(body.angular_velocity.z())),
          returned(Real(body.returned)),
          sx(Real(body.returned_slope.x())),
          sy(Real(body.returned_slope.y())),
          sz(Real(body.returned_slope.z())) {}
  };
  [[gnu::always_inline]] static Pack velocity(const Ints& tag, int axis) {
    return std::experimental::static_simd_cast<Pack>(LinkTag::velocity(tag, axis));
  }

  // with_moments: whether sum F_a x_b is measured besides force, torque and mass.
  template <typename Rule, bool with_moments>
  void apply_links(int tile);
  void measure_densities(int tile);
  LinkBody& body_of(const Batch& batch, int link) const {
    return bodies_[static_cast<std::size_t>(batch.body[link / links_at_a_time])];
  }
  const Real* excess() const { return has_rest_ ? values_.excess : values_.deviation; }

  void append(Batch& batch, const LinkTable::Tile& tile, const LinkTable::LinkRange& range, int from, int count) const;
  template <typename Rule>
  void prepare(Batch& batch) const;
  template <typename Rule>
  void find_narrow(Batch& batch) const;
  template <typename Rule, bool with_moments>
  void finish(const Batch& batch);
  template <typename Rule>
  void gather(const Batch& batch);
  void clear_second_of_narrow(const Batch& batch);
  void gather_narrow(const Batch& batch);
  void gather_upstream(const Batch& batch);
  void subtract_rest(const Batch& batch);
  void find_leaks(const Batch& batch);
  template <typename Rule, bool with_moments>
  void reflect(const Batch& batch, const Piece& piece);
  static FixedVec3 sum_of(const Piece& piece, const Real (&terms)[3][capacity]);
  void add_momentum(const Piece& piece) const;
  void add_pressure_and_mass(const Piece& piece) const;
  void add_moments(const Piece& piece) const;
  void add_by_height(const Batch& batch, const Piece& piece) const;

  const lbm::CellMap& cells_;
  const lbm::RowTiles& tiles_;
  const LinkTable& links_;
  const PeriodicBox& box_;
  const LinkOptions& options_;
  std::vector<LinkBody>& bodies_;
  std::vector<FixedTensor>* moments_;  // null: not measured
  int solids_;                         // the first bodies, of which no moments are measured
  MomentumByHeight* by_height_;        // null: not measured
  BlockFrame block_;

  LinkSlots slots_;
  Real* base_ = nullptr;
  std::array<const Real*, lbm::D3Q19::directions> sent_;  // lbm::Populations::sent()

  std::vector<Real> deviations_[2];  // rho - 1 of the cells of two neighbouring planes, even z and odd z
  int parity_ = 0;                   // of the present plane
  int last_tile_ = -1;               // the tile applied last

  TilePrefetch<Real> next_;
  Batch batches_[2];
  Values values_;
  UpstreamBodies upstream_;
  bool has_rest_;  // the fluid at rest is not the same everywhere
};

}  // namespace thalweg::bodies
