#include "lbm/sweep.hpp"

#include <experimental/simd>

namespace thalweg::lbm {

namespace stdx = std::experimental;

template <typename Real>
using Pack = stdx::native_simd<Real>;

// The 19 streams of a sweep are too many for the processor to foresee; asking for each a few cache lines ahead is worth
// a factor of 1.7 (measured: two to eight lines do equally well).
constexpr std::ptrdiff_t prefetch_bytes = 256;

template <typename Real>
int pack_width() {
  return static_cast<int>(Pack<Real>::size());
}

namespace {

// Where a pack finds its 19 populations and where it leaves them: base pointers per direction, to which the cell index
// is added. From the swapped arrangement a cell pulls f_i from x - c_i and pushes f_i^c to x + c_i; from the moved one it
// finds f_i at home and leaves f_i^c in the opposite slot.
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

template <typename Real>
void store_shear(const CellStress<Pack<Real>>& s, const RowShear<Real>& shear, int x) {
  const Pack<Real> factor = Real(3) * s.inverse_rho_tau;
  const Pack<Real> xy = s.xy * s.xy, xz = s.xz * s.xz, yz = s.yz * s.yz;
  (factor * sqrt(xy + xz)).copy_to(shear.normal_to[0] + x, stdx::element_aligned);
  (factor * sqrt(xy + yz)).copy_to(shear.normal_to[1] + x, stdx::element_aligned);
  (factor * sqrt(xz + yz)).copy_to(shear.normal_to[2] + x, stdx::element_aligned);
}

template <bool with_eddies, bool with_shear, typename Real>
void sweep_packs(const Streams<Real>& streams, std::ptrdiff_t row, const std::uint8_t* fluid_in_packs, int packs,
                 const CollisionParameters& parameters, const RowShear<Real>* shear) {
  constexpr int width = static_cast<int>(Pack<Real>::size());
  for (int p = 0; p < packs; ++p) {
    if (fluid_in_packs[p] == 0) continue;
    const std::ptrdiff_t cell = row + p * width;
    for (int i = 0; i < D3Q19::directions; ++i)
      __builtin_prefetch(streams.in[i] + cell + prefetch_bytes / static_cast<std::ptrdiff_t>(sizeof(Real)), 1);
    Pack<Real> f[D3Q19::directions];
    for (int i = 0; i < D3Q19::directions; ++i) f[i].copy_from(streams.in[i] + cell, stdx::element_aligned);
    const CellStress<Pack<Real>> stress = collide<with_eddies>(f, parameters);
    for (int i = 0; i < D3Q19::directions; ++i) f[i].copy_to(streams.out[i] + cell, stdx::element_aligned);
    if constexpr (with_shear) store_shear<Real>(stress, *shear, p * width);
  }
}

}  // namespace

template <typename Real>
void sweep_row(Populations<Real>& populations, const CellMap& cells, const CollisionParameters& parameters, int y, int z,
               const RowShear<Real>* shear) {
  const Streams<Real> streams(populations);
  const std::ptrdiff_t row = populations.indexing().index(0, y, z);
  const std::uint8_t* fluid = cells.fluid_in_packs(y, z);
  const int packs = populations.indexing().packs_per_row();
  if (parameters.smagorinsky_constant > 0.0) {
    if (shear) sweep_packs<true, true>(streams, row, fluid, packs, parameters, shear);
    else sweep_packs<true, false>(streams, row, fluid, packs, parameters, shear);
  } else {
    if (shear) sweep_packs<false, true>(streams, row, fluid, packs, parameters, shear);
    else sweep_packs<false, false>(streams, row, fluid, packs, parameters, shear);
  }
}

template int pack_width<float>();
template int pack_width<double>();
template void sweep_row(Populations<float>&, const CellMap&, const CollisionParameters&, int, int,
                        const RowShear<float>*);
template void sweep_row(Populations<double>&, const CellMap&, const CollisionParameters&, int, int,
                        const RowShear<double>*);

}  // namespace thalweg::lbm
