// SHA-256 of files, by which a run says what it has read (FIPS 180-4). Written here because a library of cryptography
// would be one more dependency of every build for one function that never changes.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace thalweg::io {

class Sha256 {
public:
  void add(std::string_view bytes);

  // The digest of all that was added, as 64 hexadecimal digits. Called once, last.
  std::string digest();

private:
  void take_block();

  std::array<std::uint32_t, 8> hash_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                     0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> block_{};
  std::size_t filled_ = 0;    // bytes of the block
  std::uint64_t length_ = 0;  // bytes
};

// Of a file; none if it cannot be read to its end.
std::optional<std::string> sha256_of(const std::filesystem::path& file);

}  // namespace thalweg::io
