// The few value types that all modules share.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>  // cross products

#include <array>
#include <cstdint>

namespace thalweg {

using Vec3 = Eigen::Vector3d;       // a vector in space: x streamwise, y cross-stream, z up
using Mat3 = Eigen::Matrix3d;       // a second-rank tensor
using Index3 = std::array<int, 3>;  // cell counts or cell coordinates (x, y, z)
using GlobalId = std::int64_t;      // a grain's name for life, from 0 on; no other grain ever has it

}  // namespace thalweg
