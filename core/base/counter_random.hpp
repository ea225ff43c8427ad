// Random numbers without a state: a hash of what the number is for, so that every rank draws the same one for a grain.
// The mixing function is SplitMix64's (Steele, Lea & Flood, OOPSLA 2014).
#pragma once

#include <cstdint>

namespace thalweg {

constexpr std::uint64_t golden_step = 0x9e3779b97f4a7c15u;  // 2^64 over the golden ratio, odd

// A bijection in which every bit of the result depends on all of x.
constexpr std::uint64_t finalised_bits(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

// SplitMix64's output for the state x.
constexpr std::uint64_t mixed_bits(std::uint64_t x) { return finalised_bits(x + golden_step); }

// Uniform in [0, 1), a multiple of 2^-53. seed: of the run; item: for example a grain's id; draw: number of the draw.
constexpr double uniform_random(std::uint64_t seed, std::uint64_t item, std::uint64_t draw) {
  return static_cast<double>(mixed_bits(mixed_bits(mixed_bits(seed) ^ item) ^ draw) >> 11) * 0x1p-53;
}

}  // namespace thalweg
