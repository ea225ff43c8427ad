// Attributes of dimension scales, as HDF5's specification of them has it ("HDF5 Dimension Scale Specification and
// Design Notes") and netCDF-4 reads them. Written here because the library that does it (hdf5_hl) is not part of every
// HDF5. Included by .cpp files only.
#pragma once

#include "io/hdf5/hdf5_archive.hpp"

#include <hdf5.h>

#include <cstdint>
#include <string>

namespace thalweg::io {

// NAME of a scale; one whose values mean nothing has the words by which netCDF knows that.
std::string name_of_scale(const DimensionScales::Scale& scale);

// More than the attributes take in the file.
std::uint64_t bytes_of_attributes(const DimensionScales& scales);

// Writes DIMENSION_LIST of every array and REFERENCE_LIST of every scale. False if that failed. Collective.
bool write_scale_attributes(hid_t file, const DimensionScales& scales);

}  // namespace thalweg::io
