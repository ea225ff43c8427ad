#include "lbm/bouzidi.ipp"

namespace thalweg::lbm {

template class LinkPass<float>;
template class LinkPass<double>;

}  // namespace thalweg::lbm
