// Arrays of HDF5 files that say their unit and what their dimensions are, by the conventions of netCDF-4: xarray,
// netCDF and h5py find `units` and the dimension scales.
//
// A dimension is named after the array of its group that holds the places along it (z, time, id), the coordinate. Where
// there is none (axis, point), a data set of that name stands for the dimension alone: the numbers from 0, with the
// NAME by which netCDF knows that they are no variable.
#pragma once

#include "core/state/records.hpp"
#include "io/hdf5/hdf5_archive.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace thalweg::io {

// What an array says of itself.
struct ArrayLabels {
  std::string unit;                     // "1" for none
  std::vector<std::string> axes;        // names of the dimensions, slowest first, but for that of the components
  std::vector<std::string> components;  // names along the last dimension; empty where it is not one of components
};

// Writes the labels of the arrays of one file.
class ArrayLabeller {
public:
  explicit ArrayLabeller(Hdf5Writer& file) : file_(file) {}

  // Writes an array and labels it; group: "" or a path. Rank 0 has the values. Collective.
  void write(const std::string& group, const Profile& array);
  void write(const std::string& group, const WholeNumbers& numbers);

  // Labels an array that has just been written. Throws std::logic_error unless there is a name for
  // each dimension, and the dimensions of a group that have the same name are of the same length. Collective.
  void label(const std::string& group, const std::string& name, const std::vector<std::uint64_t>& shape,
             const ArrayLabels& labels);

  // Names the dimensions of all arrays that were labelled. Called once, before the file is closed. Collective.
  void name_dimensions();

private:
  struct Array {
    std::string group, name;
    std::vector<std::uint64_t> shape;
    std::vector<std::string> axes;  // of all dimensions
  };

  Hdf5Writer& file_;
  std::vector<Array> arrays_;
};

}  // namespace thalweg::io
