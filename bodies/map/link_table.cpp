#include "bodies/map/link_table.hpp"

#include "core/base/check.hpp"

#include <algorithm>

namespace thalweg::bodies {

LinkSums LinkSums::of(const std::array<int, lbm::D3Q19::directions>& links) {
  LinkSums all;
  for (int i = 1; i < lbm::D3Q19::directions; ++i) {
    const auto& c = lbm::D3Q19::c[i];
    const int weight = links[static_cast<std::size_t>(i)] * (3 - lbm::D3Q19::length_squared(i));
    const int terms[size] = {1,           c[0],        c[1],        c[2],        c[0] * c[0],
                             c[1] * c[1], c[2] * c[2], c[0] * c[1], c[0] * c[2], c[1] * c[2]};
    for (std::size_t k = 0; k < size; ++k) all.sums[k] += weight * terms[k];
  }
  return all;
}

LinkSums& LinkSums::operator+=(const LinkSums& other) {
  for (std::size_t k = 0; k < size; ++k) sums[k] += other.sums[k];
  return *this;
}

LinkSums& LinkSums::operator-=(const LinkSums& other) {
  for (std::size_t k = 0; k < size; ++k) sums[k] -= other.sums[k];
  return *this;
}

Mat3 LinkSums::second() const {
  const auto at = [this](std::size_t k) { return static_cast<double>(sums[k]) / 36.0; };
  Mat3 m;
  m << at(4), at(7), at(8), at(7), at(5), at(9), at(8), at(9), at(6);
  return m;
}

void LinkStream::prefetch(std::size_t first, std::size_t count) const {
  constexpr std::size_t line = 64 / sizeof(std::uint32_t);  // links in a cache line
  for (std::size_t k = first; k < first + count + line; k += line) {
    __builtin_prefetch(xy.data() + k);
    __builtin_prefetch(tag.data() + k);
  }
}

void LinkStream::resize(std::size_t size) {
  xy.resize(size);
  tag.resize(size);
  if (!crossing.empty()) crossing.resize(size);
}

void LinkStream::fill_up(std::size_t end, std::size_t copies) {
  for (std::size_t k = end; k < end + copies; ++k) {
    xy[k] = xy[end - 1];
    tag[k] = tag[end - 1];
    if (!crossing.empty()) crossing[k] = crossing[end - 1];
  }
}

std::size_t LinkTable::count() const {
  std::size_t total = 0;
  for (const Tile& tile : tiles_) total += tile.live;
  return total;
}

const LinkSums& LinkTable::sums_of(int body) const {
  static const LinkSums none;
  return static_cast<std::size_t>(body) < sums_.size() ? sums_[static_cast<std::size_t>(body)] : none;
}

std::uint32_t LinkTable::new_chunk(Tile& tile, int body) {
  std::uint32_t chunk;
  if (tile.free_chunks.empty()) {
    chunk = static_cast<std::uint32_t>(tile.chunks.size());
    tile.chunks.emplace_back();
  } else {
    chunk = tile.free_chunks.back();
    tile.free_chunks.pop_back();
  }
  tile.chunks[chunk].body = body;
  tile.in_order = false;
  return chunk;
}

void LinkTable::drop_chunk(Tile& tile, std::uint32_t chunk) {
  sums_[static_cast<std::size_t>(tile.chunks[chunk].body)] -= tile.chunks[chunk].sums;
  tile.chunks[chunk].sums = {};
  tile.live -= tile.chunks[chunk].count;
  tile.filled -= padded(tile.chunks[chunk].count);
  tile.chunks[chunk].body = -1;
  tile.chunks[chunk].count = 0;
  tile.free_chunks.push_back(chunk);
  tile.in_order = tile.ranges_current = false;
}

void LinkTable::replace(int body, int tile, std::span<const Link> links, std::span<const LinkCrossing> crossings) {
  CHECK(body >= 0 && body < LinkTag::bodies);  // Bodies::check_count()
  CHECK(tile >= 0 && static_cast<std::size_t>(tile) < tiles_.size());
  CHECK(crossings.empty() || crossings.size() == links.size());
  if (static_cast<std::size_t>(body) >= chunks_of_.size()) {
    chunks_of_.resize(body + 1);
    sums_.resize(body + 1);
  }
  std::vector<TileChunk>& own = chunks_of_[body];
  const auto found = std::find_if(own.begin(), own.end(), [tile](const TileChunk& p) { return p.tile == tile; });
  Tile& t = tiles_[tile];
  if (links.empty()) {
    if (found == own.end()) return;
    drop_chunk(t, found->chunk);
    own.erase(found);
    return;
  }
  const std::uint32_t chunk = found == own.end() ? new_chunk(t, body) : found->chunk;
  if (found == own.end()) own.push_back({tile, chunk});
  put(t, t.chunks[chunk], links, crossings);
}

void LinkTable::remove(int body) {
  if (static_cast<std::size_t>(body) >= chunks_of_.size()) return;
  for (const TileChunk& there : chunks_of_[body]) drop_chunk(tiles_[there.tile], there.chunk);
  chunks_of_[body].clear();
}

const std::vector<LinkTable::LinkRange>& LinkTable::ranges_in_order(int tile) const {
  Tile& t = tiles_[tile];
  if (!t.in_order) {
    t.order.clear();
    for (std::uint32_t c = 0; c < t.chunks.size(); ++c)
      if (t.chunks[c].count > 0) t.order.push_back(c);
    std::sort(t.order.begin(), t.order.end(), [&t](std::uint32_t a, std::uint32_t b) {
      return t.links.xy[t.chunks[a].first] < t.links.xy[t.chunks[b].first];
    });
    t.in_order = true;
    t.ranges_current = false;
  }
  if (!t.ranges_current) {
    t.ranges.clear();
    for (const std::uint32_t c : t.order) {
      const Chunk& chunk = t.chunks[c];
      t.ranges.push_back({chunk.body, chunk.first, chunk.count, chunk.narrow});
    }
    t.ranges_current = true;
  }
  return t.ranges;
}

void LinkTable::put(Tile& tile, Chunk& chunk, std::span<const Link> links, std::span<const LinkCrossing> crossings) {
  tile.ranges_current = false;
  tile.live += links.size();
  tile.live -= chunk.count;
  tile.filled += padded(links.size());
  tile.filled -= padded(chunk.count);
  if (padded(links.size()) > chunk.capacity) {
    chunk.count = 0;
    chunk.first = static_cast<std::uint32_t>(tile.end);
    chunk.capacity = padded(static_cast<std::uint32_t>(links.size() + links.size() / 4));
    tile.end += chunk.capacity;
    tile.links.resize(tile.end);
  }
  if (!crossings.empty()) tile.links.crossing.resize(tile.links.xy.size());
  LinkSums& sums = sums_[static_cast<std::size_t>(chunk.body)];
  sums -= chunk.sums;
  const auto is_narrow = [](const Link& link) { return LinkTag::is_narrow(link.tag); };
  chunk.narrow = static_cast<std::uint32_t>(std::count_if(links.begin(), links.end(), is_narrow));
  std::uint32_t next[2] = {chunk.first + chunk.narrow,
                           chunk.first};  // first of the other links, and of the narrow ones
  std::array<int, lbm::D3Q19::directions> by_direction{};
  for (std::size_t k = 0; k < links.size(); ++k) {
    const std::uint32_t at = next[is_narrow(links[k])]++;
    tile.links.xy[at] = links[k].xy;
    tile.links.tag[at] = links[k].tag;
    if (!crossings.empty()) tile.links.crossing[at] = crossings[k];
    ++by_direction[links[k].tag & LinkTag::direction_mask];
  }
  chunk.sums = LinkSums::of(by_direction);
  sums += chunk.sums;
  chunk.count = static_cast<std::uint32_t>(links.size());
  tile.links.fill_up(chunk.first + chunk.count, padded(chunk.count) - chunk.count);
  if (tile.end > 3 * tile.filled + 4096) compact(tile);
}

void LinkTable::compact(Tile& tile) {
  LinkStream packed;
  if (!tile.links.crossing.empty()) packed.crossing.resize(tile.filled);
  packed.resize(tile.filled);
  std::size_t end = 0;
  for (Chunk& chunk : tile.chunks) {
    const auto move = [&](const auto& from, auto& to) {
      if (from.empty()) return;
      std::copy_n(from.begin() + chunk.first, padded(chunk.count), to.begin() + static_cast<std::ptrdiff_t>(end));
    };
    move(tile.links.xy, packed.xy);
    move(tile.links.tag, packed.tag);
    move(tile.links.crossing, packed.crossing);
    chunk.first = static_cast<std::uint32_t>(end);
    chunk.capacity = padded(chunk.count);
    end += chunk.capacity;
  }
  tile.end = end;
  tile.links = std::move(packed);
}

}  // namespace thalweg::bodies
