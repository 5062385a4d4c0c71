#include "manoscope/validation/pieces.hpp"

#include <gtest/gtest.h>

#include "manoscope/core/error.hpp"
#include "manoscope/core/flags.hpp"
#include "manoscope/validation/test_trial.hpp"

namespace manoscope::validation {
namespace {

struct Pieces : ::testing::Test {
  Trial trial;
  Profile state = trial.state();
  inversion::PressureReading reading = trial.reading(state);
};

TEST_F(Pieces, AreBlindToAConstantAndKeepADrop) {
  const Matrix weights = piece_weights(reading, state, kSection, 4);
  ASSERT_EQ(weights.rows(), 3);
  EXPECT_LT((weights * Eigen::VectorXd::Ones(kStations)).norm(), 1e-14);
  // Of a straight fall the pieces' means fall in equal steps, nearly: 19 stations in 4
  // pieces, so that one has 4 of them and its mean stands half a station aside, 0.5 in 4.75.
  const Array1 means = (weights * (-trial.x).matrix()).array();
  EXPECT_NEAR(means[0] / means[2], 3.0, 0.3);
}

TEST_F(Pieces, LeaveOutStationsWithoutAPressure) {
  reading.flags[7] = ReadingFlag::no_data;
  EXPECT_EQ(piece_weights(reading, state, kSection, 6).col(7).norm(), 0.0);
  EXPECT_EQ(piece_weights(reading, state, {0, 24}, 100).rows(), 23);  // one less than stations
}

TEST_F(Pieces, RefuseASectionOfOneStation) {
  EXPECT_THROW(piece_weights(reading, state, {5, 5}, 4), InputError);
  EXPECT_THROW(piece_weights(reading, state, kSection, 1), InputError);
}

TEST(ChiSquareOfDifferences, IsThatOfIndependentOnesByHand) {
  const Array1 d = (Array1(2) << 3.0, 4.0).finished();
  Matrix covariance(2, 2);
  covariance << 9.0, 0.0, 0.0, 16.0;
  const ChiSquare found = chi_square(d, covariance, 0.0);
  EXPECT_NEAR(found.value, 2.0, 1e-14);
  EXPECT_NEAR(found.tail, std::exp(-1.0), 1e-12);  // two degrees of freedom: exp(-chi2/2)
  // A floor takes the place of a covariance that is not there.
  EXPECT_NEAR(chi_square(d, Matrix::Zero(2, 2), 5.0).value, 1.0, 1e-14);
}

}  // namespace
}  // namespace manoscope::validation
