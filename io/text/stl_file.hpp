// Geometry from an STL file, text or binary.
//
// Text is read as loosely as programs write it: any case, line ends and spaces, a byte order mark, several solids,
// "end loop" for "endloop", Fortran's 1.0D-03. A binary file is one whose size fits its header, whatever its title
// says.
#pragma once

#include "core/geometry/triangle_mesh.hpp"
#include "core/parallel/ranks.hpp"

#include <filesystem>

namespace thalweg::io {

// The surface in the units of the file, corners at the same place joined, wound outwards. Throws InputError, with the
// line of a text file, where there is no such file, it is not STL, is cut off, has a corner that is not finite, or the
// surface is not closed. The first of the ranks reads the file for all. Collective.
TriangleMesh read_stl(const std::filesystem::path& path, const Ranks& ranks = {});

}  // namespace thalweg::io
