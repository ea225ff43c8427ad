#include "lbm/link_table.hpp"

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
  tag[at] = LinkTag::of(link.direction, link.distance < 0.5f, link.upstream_solid);
  distance[at] = link.distance;
  for (int a = 0; a < 3; ++a) arm[a][at] = static_cast<float>(link.arm[a]);
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
  for (const Plane& plane : planes_) total += plane.live;
  return total;
}

void LinkTable::replace(int body, std::span<const Link> links, std::span<const int> plane_of) {
  if (static_cast<std::size_t>(body) >= places_.size()) places_.resize(body + 1);
  std::vector<Place>& places = places_[body];
  std::size_t next = 0;
  // Walk the old places and the new planes together; both ascend.
  for (std::size_t old = 0; old < places.size() || next < links.size();) {
    const int new_plane = next < links.size() ? plane_of[next] : static_cast<int>(planes_.size());
    const int old_plane = old < places.size() ? places[old].plane : static_cast<int>(planes_.size());
    if (old_plane < new_plane) {  // no links left in this plane
      Plane& plane = planes_[old_plane];
      Chunk& chunk = plane.chunks[places[old].chunk];
      plane.live -= chunk.count;
      plane.in_order = false;
      chunk.body = -1;
      chunk.count = 0;
      plane.free_chunks.push_back(places[old].chunk);
      places.erase(places.begin() + old);
      continue;
    }
    std::size_t end = next;
    while (end < links.size() && plane_of[end] == new_plane) ++end;
    Plane& plane = planes_[new_plane];
    if (old_plane != new_plane) {  // a plane newly reached
      std::uint32_t fresh;
      if (plane.free_chunks.empty()) {
        fresh = static_cast<std::uint32_t>(plane.chunks.size());
        plane.chunks.emplace_back();
      } else {
        fresh = plane.free_chunks.back();
        plane.free_chunks.pop_back();
      }
      plane.chunks[fresh].body = body;
      plane.in_order = false;
      places.insert(places.begin() + old, {new_plane, fresh});
    }
    put(plane, plane.chunks[places[old].chunk], links.subspan(next, end - next));
    ++old;
    next = end;
  }
}

const std::vector<std::uint32_t>& LinkTable::chunks_in_order(int plane) const {
  Plane& p = planes_[plane];
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

void LinkTable::put(Plane& plane, Chunk& chunk, std::span<const Link> links) {
  plane.live += links.size();
  plane.live -= chunk.count;
  if (links.size() > chunk.capacity) {
    chunk.count = 0;
    chunk.first = static_cast<std::uint32_t>(plane.end);
    chunk.capacity = static_cast<std::uint32_t>(links.size() + links.size() / 4);
    plane.end += chunk.capacity;
    plane.links.resize(plane.end + slack);
  }
  for (std::size_t k = 0; k < links.size(); ++k) plane.links.put(chunk.first + k, links[k]);
  chunk.count = static_cast<std::uint32_t>(links.size());
  if (plane.end > 3 * plane.live + 4096) compact(plane);
}

void LinkTable::compact(Plane& plane) {
  LinkStream packed;
  for (Chunk& chunk : plane.chunks) {
    const std::size_t first = packed.size();
    packed.append(plane.links, chunk.first, chunk.count);
    chunk.first = static_cast<std::uint32_t>(first);
    chunk.capacity = chunk.count;
  }
  plane.end = packed.size();
  packed.resize(plane.end + slack);
  plane.links = std::move(packed);
}

}  // namespace thalweg::lbm
