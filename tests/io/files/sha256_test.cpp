// SHA-256 against the examples of FIPS 180-4 (NIST, "Secure Hash Standard"; the examples are in its "SHA256.pdf").
#include "io/files/sha256.hpp"

#include "tests/io/scratch_folder.hpp"

#include <gtest/gtest.h>

namespace thalweg::io::sha256_test {
namespace {

using testing::put;
using testing::ScratchFolder;

std::string digest_of(const std::string& bytes) {
  Sha256 sum;
  sum.add(bytes);
  return sum.digest();
}

TEST(Sha256, HasTheDigestsOfTheStandard) {
  EXPECT_EQ(digest_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(digest_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(digest_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(digest_of(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, DoesNotDependOnThePiecesItIsGiven) {
  Sha256 sum;
  for (int n = 0; n < 1000; ++n) sum.add(std::string(static_cast<std::size_t>(n % 131), 'a'));
  std::size_t length = 0;
  for (int n = 0; n < 1000; ++n) length += static_cast<std::size_t>(n % 131);
  EXPECT_EQ(sum.digest(), digest_of(std::string(length, 'a')));
}

TEST(Sha256, OfAFile) {
  const ScratchFolder folder;
  if (rank_of(MPI_COMM_WORLD) == 0) put(folder / "bytes", std::string(1000000, 'a'));
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_EQ(sha256_of(folder / "bytes"), digest_of(std::string(1000000, 'a')));
  EXPECT_EQ(sha256_of(folder / "nothing"), std::nullopt);
  EXPECT_EQ(sha256_of(folder / "."), std::nullopt);  // a folder
}

}  // namespace
}  // namespace thalweg::io::sha256_test
