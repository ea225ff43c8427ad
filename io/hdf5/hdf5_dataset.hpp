// Datasets of an archive in HDF5's terms: types of numbers, selections, names. Included by .cpp files only.
#pragma once

#include "core/base/archive.hpp"
#include "io/hdf5/hdf5_handle.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace thalweg::io {

// Types of numbers: in the file little-endian and of fixed size, in memory those of this machine.
template <typename Number>
struct Stored;
template <>
struct Stored<double> {
  static hid_t file() { return H5T_IEEE_F64LE; }
  static hid_t memory() { return H5T_NATIVE_DOUBLE; }
  static constexpr const char* name = "float64";
};
template <>
struct Stored<float> {
  static hid_t file() { return H5T_IEEE_F32LE; }
  static hid_t memory() { return H5T_NATIVE_FLOAT; }
  static constexpr const char* name = "float32";
};
template <>
struct Stored<std::int64_t> {
  static hid_t file() { return H5T_STD_I64LE; }
  static hid_t memory() { return H5T_NATIVE_INT64; }
  static constexpr const char* name = "int64";
};

// Name of a stored type, as Stored has it, or "another type".
std::string name_of_type(hid_t type);

// Shape as text: "3 x 4".
std::string shown(const std::vector<std::uint64_t>& shape);

// Number of values in a shape.
std::uint64_t volume(const std::vector<std::uint64_t>& shape);

// This rank's box in the dataset, and the same number of values in a row in memory. A rank with nothing takes part in
// the collective call with empty selections.
struct Selection {
  Handle file, memory;

  explicit Selection(const ArrayBox& box);
};

// Properties of a collective transfer.
Handle collective_transfer();

// Throws std::logic_error unless the box has 1 to 4 dimensions and this number of values.
void check_box(const std::string& path, const ArrayBox& box, std::size_t values);

// "group/name" in two parts; the group is "/" if there is none.
std::pair<std::string, std::string> group_and_name(const std::string& path);

// Attribute of every dataset.
inline constexpr const char* checksum_name = "checksum";

}  // namespace thalweg::io
