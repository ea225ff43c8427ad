#include "io/hdf5/scale_attributes.hpp"

#include "io/hdf5/hdf5_dataset.hpp"

#include <fmt/format.h>

#include <map>
#include <vector>

namespace thalweg::io {
namespace {

// Place of a scale: an array and the number of a dimension.
struct Place {
  hobj_ref_t dataset;
  unsigned dimension;
};

Handle place_type(hid_t number, std::size_t size, std::size_t of_dataset, std::size_t of_dimension) {
  Handle type(H5Tcreate(H5T_COMPOUND, size), H5Tclose);
  H5Tinsert(type, "dataset", of_dataset, H5T_STD_REF_OBJ);
  H5Tinsert(type, "dimension", of_dimension, number);
  return type;
}

bool write_attribute(hid_t file, const std::string& dataset, const char* name, hid_t file_type, hid_t memory_type,
                     std::size_t size, const void* values) {
  const Handle object(H5Oopen(file, dataset.c_str(), H5P_DEFAULT), H5Oclose);
  const hsize_t count = size;
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Handle attribute(H5Acreate2(object, name, file_type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute.good() && H5Awrite(attribute, memory_type, values) >= 0;
}

}  // namespace

std::string name_of_scale(const DimensionScales::Scale& scale) {
  return scale.is_coordinate ? group_and_name(scale.path).second
                             : fmt::format("This is a netCDF dimension but not a netCDF variable.{:10}", scale.length);
}

std::uint64_t bytes_of_attributes(const DimensionScales& scales) {
  std::uint64_t bytes = 8192 + 512 * scales.scales.size();
  for (const auto& [array, of_array] : scales.of_arrays) bytes += 256 + 128 * of_array.size();
  return bytes;
}

bool write_scale_attributes(hid_t file, const DimensionScales& scales) {
  std::map<std::string, hobj_ref_t> reference;
  std::map<std::string, std::vector<Place>> places;
  const auto refer = [&](const std::string& path) {
    return H5Rcreate(&reference[path], file, path.c_str(), H5R_OBJECT, -1) >= 0;
  };
  bool good = true;
  for (const DimensionScales::Scale& scale : scales.scales) good = refer(scale.path) && good;
  const Handle list(H5Tvlen_create(H5T_STD_REF_OBJ), H5Tclose);
  for (const auto& [array, of_array] : scales.of_arrays) {
    good = refer(array) && good;
    std::vector<hvl_t> lists;
    for (std::size_t d = 0; d < of_array.size(); ++d) {
      lists.push_back({1, &reference[of_array[d]]});
      places[of_array[d]].push_back({reference[array], static_cast<unsigned>(d)});
    }
    good = write_attribute(file, array, "DIMENSION_LIST", list, list, lists.size(), lists.data()) && good;
  }
  constexpr std::size_t of_reference = sizeof(hobj_ref_t);
  const Handle stored = place_type(H5T_STD_U32LE, of_reference + 4, 0, of_reference);
  const Handle memory = place_type(H5T_NATIVE_UINT, sizeof(Place), HOFFSET(Place, dataset), HOFFSET(Place, dimension));
  for (const auto& [scale, of_scale] : places)
    good = write_attribute(file, scale, "REFERENCE_LIST", stored, memory, of_scale.size(), of_scale.data()) && good;
  return good;
}

}  // namespace thalweg::io
