// The links of spheres.
#include "core/sphere.hpp"
#include "lbm/link_pass.ipp"

namespace thalweg::lbm {

template class LinkPass<float, Sphere>;
template class LinkPass<double, Sphere>;

}  // namespace thalweg::lbm
