#include "lbm/fluid/halo.hpp"

#include "core/parallel/mpi_session.hpp"

#include <algorithm>

namespace thalweg::lbm {

namespace {

// The 18 neighbours that D3Q19 populations reach, in an order both sides agree on.
std::vector<Index3> neighbour_offsets() {
  std::vector<Index3> offsets;
  for (int i = 1; i < D3Q19::directions; ++i) offsets.push_back({D3Q19::c[i][0], D3Q19::c[i][1], D3Q19::c[i][2]});
  return offsets;
}

Index3 plus(const Index3& a, const Index3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Index3 minus(const Index3& a) { return {-a[0], -a[1], -a[2]}; }

// True if a population of direction i leaves the block through the face or edge in direction `towards` and no other.
bool crosses(int i, const Index3& towards) {
  int axes = 0;
  for (int a = 0; a < 3; ++a) {
    if (towards[a] != 0 && D3Q19::c[i][a] != towards[a]) return false;
    axes += towards[a] != 0;
  }
  return axes == 1 || D3Q19::length_squared(i) == 2;
}

}  // namespace

template <typename Real>
Halo<Real>::Halo(const Decomposition& decomposition, MPI_Comm communicator, Populations<Real>& populations,
                 Walls<Real>& walls)
    : populations_(populations), walls_(walls) {
  const int me = rank_of(communicator);
  const Index3 here = decomposition.coordinates_of(me);
  // A message sent towards d arrives from -d: both lists run over the same d.
  for (const Index3& towards : neighbour_offsets()) {
    const int to = decomposition.rank_at(plus(here, towards));
    const int from = decomposition.rank_at(plus(here, minus(towards)));
    if (to >= 0) add_neighbour(to, towards, true);
    if (from >= 0) add_neighbour(from, towards, false);
  }
  std::vector<PackedExchange::Neighbour> neighbours;
  const auto total = [](const std::vector<StridedRange>& ranges) {
    std::size_t count = 0;
    for (const StridedRange& range : ranges) count += range.count;
    return count * sizeof(Real);
  };
  std::stable_partition(messages_.begin(), messages_.end(), [me](const Message& m) { return m.rank == me; });
  self_ = !messages_.empty() && messages_.front().rank == me ? 0 : -1;
  for (const Message& m : messages_)
    if (m.rank != me) neighbours.push_back({m.rank, 0, 0, total(m.send), total(m.receive)});
  exchange_ = PackedExchange(communicator, neighbours);
}

template <typename Real>
typename Halo<Real>::Message& Halo<Real>::message_to(int rank) {
  const auto found =
      std::find_if(messages_.begin(), messages_.end(), [rank](const Message& m) { return m.rank == rank; });
  if (found != messages_.end()) return *found;
  messages_.push_back({rank, {}, {}});
  return messages_.back();
}

template <typename Real>
void Halo<Real>::add_neighbour(int rank, const Index3& towards, bool sending) {
  Message& message = message_to(rank);
  std::vector<StridedRange>& ranges = sending ? message.send : message.receive;
  const Index3& n = populations_.indexing().size();
  for (int i = 1; i < D3Q19::directions; ++i) {
    if (!crosses(i, towards)) continue;
    // The cells the populations come from: the sender's outermost layer, which is the receiver's ghost layer.
    Index3 begin, end;
    for (int a = 0; a < 3; ++a) {
      const int c = D3Q19::c[i][a];
      if (towards[a] != 0) {
        begin[a] = sending ? (towards[a] > 0 ? n[a] - 1 : 0) : (towards[a] > 0 ? -1 : n[a]);
        end[a] = begin[a] + 1;
      } else {
        // Populations that also leave sideways go to the edge neighbour, unless a wall there reflects them.
        begin[a] = c < 0 && !walls_.present(a, false) ? 1 : 0;
        end[a] = c > 0 && !walls_.present(a, true) ? n[a] - 1 : n[a];
      }
    }
    add_population(ranges, i, begin, end);
  }
  add_wall_lines(ranges, towards, sending);
}

template <typename Real>
void Halo<Real>::add_population(std::vector<StridedRange>& ranges, int direction, const Index3& begin,
                                const Index3& end) {
  const CellIndexing& indexing = populations_.indexing();
  const bool along_x = end[0] - begin[0] > 1;
  for (int z = begin[2]; z < end[2]; ++z)
    for (int y = begin[1]; y < (along_x ? end[1] : begin[1] + 1); ++y) {
      const std::ptrdiff_t cell = indexing.index(begin[0], y, z);
      ranges.push_back({{populations_.plane(D3Q19::opposite(direction)) + cell,
                         populations_.plane(direction) + cell + indexing.offset(direction)},
                        along_x ? end[0] - begin[0] : end[1] - begin[1],
                        along_x ? 1 : indexing.row_stride()});
    }
}

template <typename Real>
void Halo<Real>::add_wall_lines(std::vector<StridedRange>& ranges, const Index3& towards, bool sending) {
  int axis = -1;
  for (int a = 0; a < 3; ++a)
    if (towards[a] != 0) axis = axis < 0 ? a : 3;
  if (axis > 2) return;  // an edge neighbour
  for (int face = 0; face < 6; ++face) {
    FaceField<Real>& field = walls_.bounced(face);
    const int normal = face / 2;
    if (field.values.empty() || normal == axis) continue;
    const bool axis_is_u = axis == (normal == 0 ? 1 : 0);
    const int n = axis_is_u ? field.nu : field.nv, length = axis_is_u ? field.nv : field.nu;
    const int line = sending ? (towards[axis] > 0 ? n - 1 : 0) : (towards[axis] > 0 ? -1 : n);
    Real* first = axis_is_u ? &field.at(line, 0) : &field.at(0, line);
    ranges.push_back({{first, first}, length, axis_is_u ? field.nu + 2 : 1});
  }
}

template <typename Real>
void Halo<Real>::start() {
  const int now = populations_.arrangement() == Arrangement::swapped ? 0 : 1;
  std::size_t n = 0;
  for (const Message& message : messages_) {
    if (&message - messages_.data() == self_) continue;
    Real* buffer = exchange_.template send_buffer<Real>(n++);
    for (const StridedRange& range : message.send)
      for (int k = 0; k < range.count; ++k) *buffer++ = range.at[now][k * range.stride];
  }
  exchange_.start();
  if (self_ >= 0) {
    const Message& own = messages_[self_];
    for (std::size_t r = 0; r < own.send.size(); ++r) {
      const StridedRange &from = own.send[r], &to = own.receive[r];
      for (int k = 0; k < from.count; ++k) to.at[now][k * to.stride] = from.at[now][k * from.stride];
    }
  }
}

template <typename Real>
void Halo<Real>::finish() {
  exchange_.finish();
  const int now = populations_.arrangement() == Arrangement::swapped ? 0 : 1;
  std::size_t n = 0;
  for (const Message& message : messages_) {
    if (&message - messages_.data() == self_) continue;
    const Real* buffer = exchange_.template receive_buffer<Real>(n++);
    for (const StridedRange& range : message.receive)
      for (int k = 0; k < range.count; ++k) range.at[now][k * range.stride] = *buffer++;
  }
}

template class Halo<float>;
template class Halo<double>;

}  // namespace thalweg::lbm
