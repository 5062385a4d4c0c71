#include "manoscope/twin/truth.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "manoscope/core/error.hpp"
#include "tests/support/paths.hpp"

namespace manoscope::twin {
namespace {

class TruthFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              (std::string("truth_test_") +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_ / "truth");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& text) { std::ofstream(folder_ / "truth/truth.csv") << text; }
  /// The message of the fault that reading gives.
  std::string fault() {
    try {
      read_truth(folder_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no fault";
  }

  std::filesystem::path folder_;
};

TEST_F(TruthFile, ReadsBackWhatWasWritten) {
  Truth truth;
  truth.x = Array1::LinSpaced(5, 0.1e-3, 15.4e-3);
  truth.runs.push_back({"Q5", Array1::LinSpaced(5, 2000.0, 300.0), Array1::Constant(5, -3e-6)});
  truth.runs.push_back({"Q12.5", Array1::LinSpaced(5, 4e3, 310.0), Array1::Constant(5, 17e-6)});
  write(truth_csv(truth));
  for (const auto& path : {folder_, folder_ / "truth", folder_ / "truth/truth.csv"}) {
    const Truth read = read_truth(path);
    ASSERT_EQ(read.runs.size(), 2u);
    EXPECT_EQ(read.runs[1].run, "Q12.5");
    // Half of the last digit written: 10 nm in x, 1 mPa, 1 pm.
    EXPECT_LT((read.x - truth.x).abs().maxCoeff(), 0.51e-8);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_LT((read.runs[i].pressure - truth.runs[i].pressure).abs().maxCoeff(), 0.51e-3);
      EXPECT_LT((read.runs[i].deflection - truth.runs[i].deflection).abs().maxCoeff(), 0.51e-12);
    }
  }
}

TEST_F(TruthFile, NamesWhatIsWrongWithATable) {
  EXPECT_NE(fault().find("truth.csv"), std::string::npos);  // missing
  write("x,p_Pa_Q5,zeta_um_Q5\n0,1,2\n1,1,2\n");
  EXPECT_NE(fault().find("no column \"x_mm\""), std::string::npos) << fault();
  write("x_mm,p_Pa_Q5\n0,1\n1,1\n");
  EXPECT_NE(fault().find("without \"zeta_um_Q5\""), std::string::npos) << fault();
  write("x_mm,zeta_um_Q5\n0,1\n1,1\n");
  EXPECT_NE(fault().find("p_Pa_"), std::string::npos) << fault();
  write("x_mm,p_Pa_Q5,zeta_um_Q5\n0,1,2\n1,wide,2\n");
  EXPECT_NE(fault().find("truth.csv:3"), std::string::npos) << fault();
  write("x_mm,p_Pa_Q5,zeta_um_Q5\n0,1,2\n0,1,2\n");
  EXPECT_NE(fault().find("does not grow"), std::string::npos) << fault();
  write("x_mm,p_Pa_Q5,zeta_um_Q5\n0,1,2\n");
  EXPECT_NE(fault().find("1 row(s)"), std::string::npos) << fault();
}

TEST(Truth, OfThePracticeExperimentsCanBeRead) {
  const auto folder = std::filesystem::path(test_paths::shared) / "data/practice/S1";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no practice experiment " << folder;
  const Truth truth = read_truth(folder);
  ASSERT_EQ(truth.runs.size(), 8u);
  EXPECT_EQ(truth.runs.front().run, "Q5");
  EXPECT_NEAR(truth.x(0), 0.00591e-3, 1e-12);
  EXPECT_NEAR(truth.runs.front().pressure(0), 1929.489, 1e-9);
  EXPECT_NEAR(truth.runs.back().deflection(0), 0.403138e-6, 1e-15);
}

}  // namespace
}  // namespace manoscope::twin
