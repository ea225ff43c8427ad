// A symmetric tensor in three dimensions. Number is a plain number or a SIMD pack.
#pragma once

#include "lbm/lattice/pack_constant.hpp"

namespace thalweg::lbm {

template <typename Number>
struct Symmetric {
  Number xx, yy, zz, xy, xz, yz;

  [[gnu::always_inline]] Number trace() const { return xx + yy + zz; }
  [[gnu::always_inline]] Symmetric traceless() const {
    const Number third = pack_constant<Number>(1.0 / 3.0) * trace();
    return {xx - third, yy - third, zz - third, xy, xz, yz};
  }
  // The sum of the squares of all nine components.
  [[gnu::always_inline]] Number squared() const {
    return (xx * xx + yy * yy + zz * zz) + pack_constant<Number>(2) * (xy * xy + xz * xz + yz * yz);
  }
  [[gnu::always_inline]] Number determinant() const {
    return xx * (yy * zz - yz * yz) + (xy * (xz * yz - xy * zz) + xz * (xy * yz - xz * yy));
  }
};

}  // namespace thalweg::lbm
