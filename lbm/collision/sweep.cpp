#include "lbm/collision/sweep.hpp"

#include <algorithm>
#include <experimental/simd>
#include <utility>

namespace thalweg::lbm {

namespace stdx = std::experimental;

template <typename Real>
using Pack = stdx::native_simd<Real>;

template <typename Real>
int pack_width() {
  return static_cast<int>(Pack<Real>::size());
}

namespace {

// Slots that a pack reads its 19 populations from and writes them to: base pointers per direction, to which the cell
// index is added. From the swapped arrangement a cell pulls f_i from x - c_i and pushes f_i^c to x + c_i; from the
// moved one it finds f_i at home and leaves f_i^c in the opposite slot.
template <typename Real>
struct Streams {
  const Real* in[D3Q19::directions];
  Real* out[D3Q19::directions];

  explicit Streams(Populations<Real>& populations) {
    for (int i = 0; i < D3Q19::directions; ++i) {
      const int opposite = D3Q19::opposite(i);
      if (populations.arrangement() == Arrangement::swapped) {
        in[i] = populations.plane(opposite) + populations.indexing().offset(opposite);
        out[i] = populations.plane(i) + populations.indexing().offset(i);
      } else {
        in[i] = populations.plane(i);
        out[i] = populations.plane(opposite);
      }
    }
  }
};

// Results of the first pass over a segment of a row for the second, pack by pack. Four packs of 19 populations stay in
// the first-level cache between the passes with room to spare; eight and more were measured to be slower.
template <typename Real>
struct RowSegment {
  static constexpr int packs = 4;
  Pack<Real> deviation[packs], mx[packs], my[packs], mz[packs], inverse_rho[packs], omega[packs];
  Pack<Real> xy[packs], xz[packs], yz[packs], bulk[packs];
};

template <typename Real>
[[gnu::always_inline]] inline void load_pack(Pack<Real> (&f)[D3Q19::directions], const Streams<Real>& streams,
                                             std::ptrdiff_t cell) {
  for_each_direction([&]<int i>() __attribute__((always_inline)) {
    f[i].copy_from(streams.in[i] + cell, stdx::element_aligned);
  });
}

template <typename Real>
[[gnu::always_inline]] inline void prefetch_pack(const Streams<Real>& streams, std::ptrdiff_t cell) {
  for_each_direction([&]<int i>() __attribute__((always_inline)) {
    __builtin_prefetch(streams.in[i] + cell + prefetch_bytes / static_cast<std::ptrdiff_t>(sizeof(Real)), 1);
  });
}

// A row, and what CellMap knows of its packs.
struct RowCells {
  std::ptrdiff_t first;
  int packs;
  const std::uint8_t* fluid;
  const std::uint16_t* beside_bodies;
  const std::uint16_t* in_gaps;
};

// Variant of the sweep that a row takes.
struct Kind {
  CollisionModel model;
  SubgridModel subgrid;
  bool bulk, shear;
};

template <Kind kind, typename Real>
[[gnu::always_inline]] inline void measure_pack(const Streams<Real>& streams, std::ptrdiff_t cell,
                                                const CollisionConstants<Pack<Real>>& constants,
                                                RowSegment<Real>& segment, int p) {
  Pack<Real> f[D3Q19::directions];
  load_pack(f, streams, cell);
  const CellMoments<Pack<Real>> m = moments_of<kind.subgrid, kind.bulk>(f, constants);
  segment.deviation[p] = m.deviation;
  segment.mx[p] = m.mx;
  segment.my[p] = m.my;
  segment.mz[p] = m.mz;
  segment.inverse_rho[p] = m.inverse_rho;
  segment.omega[p] = m.omega;
  if constexpr (kind.bulk) segment.bulk[p] = m.bulk;
  if constexpr (kind.shear) {
    segment.xy[p] = m.pi.xy;
    segment.xz[p] = m.pi.xz;
    segment.yz[p] = m.pi.yz;
  }
}

// Calmness in the lanes of `beside_bodies` (a bit each, as in `in_gaps`), 0 in the others. All packs pass through the
// same arithmetic, so that a cell's bits do not depend on its neighbours in the pack.
template <typename Real>
[[gnu::always_inline]] inline Pack<Real> calmness_in_lanes(const Pack<Real> (&f)[D3Q19::directions],
                                                           const CellMoments<Pack<Real>>& m,
                                                           const CollisionConstants<Pack<Real>>& constants,
                                                           unsigned beside_bodies, unsigned in_gaps) {
  if (beside_bodies == 0) return Real(0);
  const Pack<Real> near([&](auto lane) { return Real(beside_bodies >> lane & 1u); });
  const Pack<Real> gap([&](auto lane) { return Real(in_gaps >> lane & 1u); });
  return near * calmness_of(f, m, constants, gap);
}

template <Kind kind, typename Real>
[[gnu::always_inline]] inline void relax_pack(const Streams<Real>& streams, std::ptrdiff_t cell,
                                              const CollisionConstants<Pack<Real>>& constants,
                                              const RowSegment<Real>& s, int p, unsigned beside_bodies,
                                              unsigned in_gaps) {
  Pack<Real> f[D3Q19::directions];
  CellMoments<Pack<Real>> m;
  m.deviation = s.deviation[p];
  m.mx = s.mx[p];
  m.my = s.my[p];
  m.mz = s.mz[p];
  m.inverse_rho = s.inverse_rho[p];
  m.omega = s.omega[p];
  if constexpr (kind.bulk) m.bulk = s.bulk[p];
  load_pack(f, streams, cell);
  if constexpr (kind.model == CollisionModel::trt_at_bodies)
    relax_trt_at_bodies<kind.bulk>(f, m, constants, calmness_in_lanes<Real>(f, m, constants, beside_bodies, in_gaps));
  else
    relax<kind.model, kind.bulk>(f, m, constants);
  for_each_direction([&]<int i>() __attribute__((always_inline)) {
    f[i].copy_to(streams.out[i] + cell, stdx::element_aligned);
  });
}

// A function of its own, so that the results of a row do not depend on whether its shear rates are stored.
template <typename Real>
[[gnu::noinline]] void store_shear(const RowSegment<Real>& s, int p, const RowShear<Real>& shear, int x) {
  const Pack<Real> factor = Real(3) * s.omega[p] * s.inverse_rho[p];
  const Pack<Real> xy = s.xy[p] * s.xy[p], xz = s.xz[p] * s.xz[p], yz = s.yz[p] * s.yz[p];
  (factor * sqrt(xy + xz)).copy_to(shear.normal_to[0] + x, stdx::element_aligned);
  (factor * sqrt(xy + yz)).copy_to(shear.normal_to[1] + x, stdx::element_aligned);
  (factor * sqrt(xz + yz)).copy_to(shear.normal_to[2] + x, stdx::element_aligned);
}

// A function of its own, likewise.
template <typename Real>
[[gnu::noinline]] void store_moments(const RowSegment<Real>& s, int p, const RowMoments<Real>& moments, int x) {
  s.deviation[p].copy_to(moments.deviation + x, stdx::element_aligned);
  s.mx[p].copy_to(moments.momentum[0] + x, stdx::element_aligned);
  s.my[p].copy_to(moments.momentum[1] + x, stdx::element_aligned);
  s.mz[p].copy_to(moments.momentum[2] + x, stdx::element_aligned);
}

// Moments of a whole segment first, then its relaxation: either pass alone is short enough for the processor to work on
// several packs at once, while one long pass waits for its own divisions and roots.
template <Kind kind, typename Real>
void sweep_packs(const Streams<Real>& streams, const RowCells& row, const CollisionParameters& parameters,
                 const RowOutput<Real>& output) {
  constexpr int width = static_cast<int>(Pack<Real>::size());
  const CollisionConstants<Pack<Real>> constants(parameters);
  RowSegment<Real> segment;
  for (int first = 0; first < row.packs; first += RowSegment<Real>::packs) {
    const int count = std::min(RowSegment<Real>::packs, row.packs - first);
    for (int p = 0; p < count; ++p) {
      if (row.fluid[first + p] == 0) continue;
      measure_pack<kind>(streams, row.first + (first + p) * width, constants, segment, p);
    }
    for (int p = 0; p < count; ++p) {
      if (row.fluid[first + p] == 0) continue;
      const std::ptrdiff_t cell = row.first + (first + p) * width;
      prefetch_pack(streams, cell);
      relax_pack<kind>(streams, cell, constants, segment, p, row.beside_bodies[first + p], row.in_gaps[first + p]);
      if constexpr (kind.shear) store_shear(segment, p, *output.shear, (first + p) * width);
      if (output.moments) store_moments(segment, p, *output.moments, (first + p) * width);
    }
  }
}

// Calls visit.operator()<value>() with the value as a constant.
template <typename Visit>
void as_constant(bool value, Visit visit) {
  if (value)
    visit.template operator()<true>();
  else
    visit.template operator()<false>();
}

template <CollisionModel model, SubgridModel subgrid, typename Real>
void sweep_row_with(const Streams<Real>& streams, const RowCells& row, const CollisionParameters& parameters,
                    const RowOutput<Real>& output) {
  as_constant(parameters.with_bulk(), [&]<bool bulk>() {
    as_constant(output.shear != nullptr, [&]<bool with_shear>() {
      sweep_packs<Kind{model, subgrid, bulk, with_shear}>(streams, row, parameters, output);
    });
  });
}

}  // namespace

template <typename Real>
void sweep_row(Populations<Real>& populations, const CellMap& cells, const CollisionParameters& parameters, int y,
               int z, const RowOutput<Real>& output) {
  const Streams<Real> streams(populations);
  const RowCells row{populations.indexing().index(0, y, z), populations.indexing().packs_per_row(),
                     cells.fluid_in_packs(y, z), cells.beside_bodies(y, z), cells.in_gaps(y, z)};
  with_constant(parameters.model, [&]<CollisionModel model>() {
    with_constant(parameters.subgrid.model(),
                  [&]<SubgridModel subgrid>() { sweep_row_with<model, subgrid>(streams, row, parameters, output); });
  });
}

template int pack_width<float>();
template int pack_width<double>();
template void sweep_row(Populations<float>&, const CellMap&, const CollisionParameters&, int, int,
                        const RowOutput<float>&);
template void sweep_row(Populations<double>&, const CellMap&, const CollisionParameters&, int, int,
                        const RowOutput<double>&);

}  // namespace thalweg::lbm
