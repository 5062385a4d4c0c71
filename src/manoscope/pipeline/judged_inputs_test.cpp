#include "manoscope/pipeline/judged_inputs.hpp"

#include <gtest/gtest.h>

#include <string>

#include "manoscope/core/error.hpp"

namespace manoscope::pipeline {
namespace {

/// A result and a truth of three maps each.
struct Pair {
  results::Measurement result;
  twin::Truth truth;

  Pair() {
    result.title = "mine, seed 2";
    result.inputs = "h00.gsf  aa\nh 01.gsf  bb\nf00.gsf  cc\n";
    truth.name = "mine, seed 1";
    truth.inputs = result.inputs;
  }
};

TEST(JudgedInputs, OfTheSameMapsPassWhateverTheirNamesAndOrder) {
  Pair pair;
  EXPECT_NO_THROW(check_same_inputs(pair.result, pair.truth));
  pair.result.inputs = "renamed.gsf  cc\nh00.gsf  aa\n";  // one level was left out
  EXPECT_NO_THROW(check_same_inputs(pair.result, pair.truth));
}

TEST(JudgedInputs, OfOtherMapsAreRefusedWithBothNames) {
  Pair pair;
  pair.result.inputs = "h00.gsf  aa\nh 01.gsf  b2\nf00.gsf  c2\n";
  try {
    check_same_inputs(pair.result, pair.truth);
    FAIL();
  } catch (const InputError& error) {
    for (const char* part : {"2 of the 3", "mine, seed 2", "mine, seed 1", "h 01.gsf first"}) {
      EXPECT_NE(error.found().find(part), std::string::npos) << error.what();
    }
  }
}

TEST(JudgedInputs, AreNotComparedWhereTheTruthTellsOfNone) {
  Pair pair;
  pair.truth.inputs.clear();
  EXPECT_NO_THROW(check_same_inputs(pair.result, pair.truth));
}

}  // namespace
}  // namespace manoscope::pipeline
