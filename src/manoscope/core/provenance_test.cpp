#include "manoscope/core/provenance.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "manoscope/core/error.hpp"

namespace manoscope {
namespace {

TEST(Sha256, AgreesWithThePublishedExample) {
  // FIPS 180-2, appendix B.1.
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(ReadFile, SaysWhatIsWrongWithAFile) {
  const auto folder = std::filesystem::temp_directory_path() / "manoscope_read_file_test";
  std::filesystem::create_directories(folder);
  EXPECT_THROW(read_file(folder / "absent"), InputError);
  EXPECT_THROW(read_file(folder), InputError);
  const auto path = folder / "ten";
  std::ofstream(path) << "0123456789";
  EXPECT_EQ(read_file(path), "0123456789");
  EXPECT_THROW(read_file(path, 9), InputError);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace manoscope
