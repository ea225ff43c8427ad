// Version of the HDF5 library that the program runs with.
#pragma once

#include <string>

namespace thalweg::io {

std::string hdf5_version();  // "1.10.8"

}  // namespace thalweg::io
