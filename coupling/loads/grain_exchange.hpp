// Coupling state of a grain that lasts from one step to the next, as named values in the columns of plain numbers that
// dem carries with the grain (dem/motion/grain_store.hpp). Number: double, or const double for reading.
#pragma once

#include "core/base/check.hpp"
#include "core/base/types.hpp"

#include <span>
#include <type_traits>

namespace thalweg::coupling {

template <typename Number>
class GrainExchange {
  template <typename Value>
  using Of = std::conditional_t<std::is_const_v<Number>, const Value, Value>;
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

public:
  using Vector = Eigen::Map<Of<Vec3>>;
  using Tensor = Eigen::Map<Of<RowMajor>>;

  static constexpr int width = 34;  // columns

  explicit GrainExchange(std::span<Number> columns) : columns_(columns) { CHECK(columns.size() >= width); }

  // Columns that other ranks need in every step: what the links return, and the density around the grain. (Ghosts
  // update their link_position themselves.)
  static constexpr std::size_t first_shared = 18, shared = 5;

  Vector link_position() const { return vector(0); }  // the place its cells stand for, m
  Vector last_force() const { return vector(3); }     // force of the last exchange, N
  Vector last_torque() const { return vector(6); }    // N m
  Vector earlier_force() const { return vector(9); }  // force of the one before, N
  Vector earlier_torque() const { return vector(12); }

  // Number of exchanges so far, at most 2.
  int exchanges() const { return static_cast<int>(columns_[15]); }
  void set_exchanges(int count) const { columns_[15] = count; }

  // Lattice units. Of a clump, owed_mass, mean_loss and wanted_return are in its first member's.
  Number& owed_mass() const { return columns_[16]; }         // to the fluid
  Number& mean_loss() const { return columns_[17]; }         // of mass a step
  Number& returned_density() const { return columns_[18]; }  // mass that the links return in the coming step:
  Vector returned_slope() const { return vector(19); }       // mass_return.hpp
  Number& surrounding() const { return columns_[22]; }       // rho - rho_rest of the fluid around the grain
  Number& wanted_return() const { return columns_[23]; }     // of mass; the links return the mean of the last two
  void forget_lattice_units() const {
    for (Number& value : columns_.subspan(16, 8)) value = 0.0;
  }

  // Stress of the last exchange, Pa, if that measured it.
  bool has_last_stress() const { return columns_[24] != 0.0; }
  void set_has_last_stress(bool has) const { columns_[24] = has ? 1.0 : 0.0; }
  Tensor last_stress() const { return Tensor(columns_.data() + 25); }

private:
  Vector vector(std::size_t first) const { return Vector(columns_.data() + first); }

  std::span<Number> columns_;
};

}  // namespace thalweg::coupling
