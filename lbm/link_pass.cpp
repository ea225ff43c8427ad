#include "lbm/link_pass.ipp"

namespace thalweg::lbm {

template class LinkPass<float>;
template class LinkPass<double>;

}  // namespace thalweg::lbm
