// Geometry from an STL file, text or binary.
#pragma once

#include "core/triangle_mesh.hpp"

#include <filesystem>

namespace thalweg::io {

// The surface in the units of the file, corners at the same place joined, wound outwards. Throws InputError where there
// is no such file, it is not STL, or the surface is not closed.
TriangleMesh read_stl(const std::filesystem::path& path);

}  // namespace thalweg::io
