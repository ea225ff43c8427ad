#include "lbm/link_table.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace thalweg::lbm {

void LinkStream::resize(std::size_t links) {
  cell.resize(links);
  tag.resize(links);
  distance.resize(links);
  for (std::vector<float>& a : arm) a.resize(links);
}

void LinkStream::put(std::size_t at, const Link& link) {
  cell[at] = link.cell;
  tag[at] = LinkTag::of(link.direction, link.distance < 0.5f, link.upstream_body);
  distance[at] = link.distance;
  for (int a = 0; a < 3; ++a) arm[a][at] = static_cast<float>(link.arm[a]);
}

void LinkStream::ask_for(std::size_t first, std::size_t count) const {
  constexpr std::size_t line = 64 / sizeof(float);  // links in a cache line
  for (std::size_t k = first; k < first + count + line; k += line) {
    __builtin_prefetch(cell.data() + k);
    __builtin_prefetch(tag.data() + k);
    __builtin_prefetch(distance.data() + k);
    for (const std::vector<float>& a : arm) __builtin_prefetch(a.data() + k);
  }
}

void LinkStream::append(const LinkStream& other, std::size_t first, std::size_t count) {
  const auto add = [&](auto& to, const auto& from) {
    to.insert(to.end(), from.begin() + static_cast<std::ptrdiff_t>(first),
              from.begin() + static_cast<std::ptrdiff_t>(first + count));
  };
  add(cell, other.cell);
  add(tag, other.tag);
  add(distance, other.distance);
  for (int a = 0; a < 3; ++a) add(arm[a], other.arm[a]);
}

std::size_t LinkTable::count() const {
  std::size_t total = 0;
  for (const Tile& tile : tiles_) total += tile.live;
  return total;
}

void LinkTable::replace(int body, std::span<const Link> links, std::span<const int> tile_of) {
  if (body >= LinkTag::bodies)
    throw InputError(
        fmt::format("One rank would hold the links of more than {} grains; use more ranks.", LinkTag::bodies));
  if (static_cast<std::size_t>(body) >= places_.size()) places_.resize(body + 1);
  std::vector<Place>& places = places_[body];
  std::size_t next = 0;
  // Walk the old places and the new tiles together; both ascend.
  for (std::size_t old = 0; old < places.size() || next < links.size();) {
    const int new_tile = next < links.size() ? tile_of[next] : static_cast<int>(tiles_.size());
    const int old_tile = old < places.size() ? places[old].tile : static_cast<int>(tiles_.size());
    if (old_tile < new_tile) {  // no links left in this tile
      Tile& tile = tiles_[old_tile];
      Chunk& chunk = tile.chunks[places[old].chunk];
      tile.live -= chunk.count;
      tile.in_order = false;
      chunk.body = -1;
      chunk.count = 0;
      tile.free_chunks.push_back(places[old].chunk);
      places.erase(places.begin() + old);
      continue;
    }
    std::size_t end = next;
    while (end < links.size() && tile_of[end] == new_tile) ++end;
    Tile& tile = tiles_[new_tile];
    if (old_tile != new_tile) {  // a tile newly reached
      std::uint32_t fresh;
      if (tile.free_chunks.empty()) {
        fresh = static_cast<std::uint32_t>(tile.chunks.size());
        tile.chunks.emplace_back();
      } else {
        fresh = tile.free_chunks.back();
        tile.free_chunks.pop_back();
      }
      tile.chunks[fresh].body = body;
      tile.in_order = false;
      places.insert(places.begin() + old, {new_tile, fresh});
    }
    put(tile, tile.chunks[places[old].chunk], links.subspan(next, end - next));
    ++old;
    next = end;
  }
}

void LinkTable::ask_for(int body) const {
  if (static_cast<std::size_t>(body) >= places_.size()) return;
  for (const Place& place : places_[body]) {
    const Tile& tile = tiles_[place.tile];
    const Chunk& chunk = tile.chunks[place.chunk];
    tile.links.ask_for(chunk.first, chunk.count);
  }
}

const std::vector<std::uint32_t>& LinkTable::chunks_in_order(int tile) const {
  Tile& p = tiles_[tile];
  if (!p.in_order) {
    p.order.clear();
    for (std::uint32_t c = 0; c < p.chunks.size(); ++c)
      if (p.chunks[c].count > 0) p.order.push_back(c);
    std::sort(p.order.begin(), p.order.end(), [&p](std::uint32_t a, std::uint32_t b) {
      return p.links.cell[p.chunks[a].first] < p.links.cell[p.chunks[b].first];
    });
    p.in_order = true;
  }
  return p.order;
}

void LinkTable::put(Tile& tile, Chunk& chunk, std::span<const Link> links) {
  tile.live += links.size();
  tile.live -= chunk.count;
  if (links.size() > chunk.capacity) {
    chunk.count = 0;
    chunk.first = static_cast<std::uint32_t>(tile.end);
    chunk.capacity = static_cast<std::uint32_t>(links.size() + links.size() / 4);
    tile.end += chunk.capacity;
    tile.links.resize(tile.end + slack);
  }
  for (std::size_t k = 0; k < links.size(); ++k) tile.links.put(chunk.first + k, links[k]);
  chunk.count = static_cast<std::uint32_t>(links.size());
  if (tile.end > 3 * tile.live + 4096) compact(tile);
}

void LinkTable::compact(Tile& tile) {
  LinkStream packed;
  for (Chunk& chunk : tile.chunks) {
    const std::size_t first = packed.size();
    packed.append(tile.links, chunk.first, chunk.count);
    chunk.first = static_cast<std::uint32_t>(first);
    chunk.capacity = chunk.count;
  }
  tile.end = packed.size();
  packed.resize(tile.end + slack);
  tile.links = std::move(packed);
}

}  // namespace thalweg::lbm
