#pragma once

// For the tests of this folder only.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "manoscope/core/error.hpp"
#include "manoscope/io/reader.hpp"
#include "manoscope/io/test_bytes.hpp"
#include "tests/support/paths.hpp"

namespace manoscope::io::testing {

/// A folder of one test, removed with everything in it.
class TestFolder {
 public:
  TestFolder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            ("manoscope_io_" + std::to_string(::getpid()) + "_" + test->test_suite_name() + "_" +
             test->name());
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    std::ofstream out(path_ / name, std::ios::binary);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

/// What `body` complains about: "<where> | <found> | <mend>", or "" if it does not.
template <class Body>
std::string complaint(Body&& body) {
  try {
    body();
  } catch (const InputError& error) {
    return error.where() + " | " + error.found() + " | " + error.mend();
  }
  return {};
}

/// What reading a file of these bytes complains about, as above.
inline std::string refusal(const TestFolder& folder, const std::string& name,
                           std::string_view bytes) {
  return complaint([&] { static_cast<void>(read_channels(folder.write(name, bytes))); });
}

inline ::testing::AssertionResult contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "\"" << text << "\" does not contain \"" << part << "\"";
}

/// Shared practice data; empty where it is absent.
inline std::filesystem::path shared_data(const std::string& name) {
  const std::filesystem::path path = std::filesystem::path(test_paths::shared) / "data" / name;
  return std::filesystem::exists(path) ? path : std::filesystem::path();
}

}  // namespace manoscope::io::testing
