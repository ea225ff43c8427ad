#include "coupling/resolved_system.ipp"

#include "coupling/resolved_loads.ipp"
#include "coupling/resolved_sample.ipp"

namespace thalweg::coupling {

template class ResolvedSystem<float>;
template class ResolvedSystem<double>;

}  // namespace thalweg::coupling
