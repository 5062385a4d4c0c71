// NIST's Statistical Reference Datasets for nonlinear regression, https://www.itl.nist.gov/div898/
// strd/nls/nls_main.shtml: 27 problems, each with two starts. The files lie with the practice data,
// not with the sources; models are written here from the formulas that the files state.
#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "manoscope/numerics/least_squares.hpp"
#include "tests/support/paths.hpp"

namespace manoscope::numerics {
namespace {

using Eigen::VectorXd;

/// y at predictors x (one or two) for parameters b.
using Formula = double (*)(const VectorXd& b, const double* x);

struct Reference {
  const char* name;
  Formula formula;
};

double square(double x) { return x * x; }

double gauss(const VectorXd& b, const double* x) {
  return b(0) * std::exp(-b(1) * x[0]) + b(2) * std::exp(-square((x[0] - b(3)) / b(4))) +
         b(5) * std::exp(-square((x[0] - b(6)) / b(7)));
}

double lanczos(const VectorXd& b, const double* x) {
  return b(0) * std::exp(-b(1) * x[0]) + b(2) * std::exp(-b(3) * x[0]) +
         b(4) * std::exp(-b(5) * x[0]);
}

double chwirut(const VectorXd& b, const double* x) {
  return std::exp(-b(0) * x[0]) / (b(1) + b(2) * x[0]);
}

double saturation(const VectorXd& b, const double* x) {
  return b(0) * (1.0 - std::exp(-b(1) * x[0]));
}

double cubic_over_cubic(const VectorXd& b, const double* x) {
  const double t = x[0];
  return (b(0) + t * (b(1) + t * (b(2) + t * b(3)))) / (1.0 + t * (b(4) + t * (b(5) + t * b(6))));
}

double cycle(double c, double s, double period, double x) {
  const double phase = 2.0 * std::numbers::pi * x / period;
  return c * std::cos(phase) + s * std::sin(phase);
}

const Reference kReferences[] = {
    // lower level of difficulty
    {"Misra1a", saturation},
    {"Chwirut2", chwirut},
    {"Chwirut1", chwirut},
    {"Lanczos3", lanczos},
    {"Gauss1", gauss},
    {"Gauss2", gauss},
    {"DanWood", [](const VectorXd& b, const double* x) { return b(0) * std::pow(x[0], b(1)); }},
    {"Misra1b",
     [](const VectorXd& b, const double* x) {
       return b(0) * (1.0 - 1.0 / square(1.0 + 0.5 * b(1) * x[0]));
     }},
    // average
    {"Kirby2",
     [](const VectorXd& b, const double* x) {
       const double t = x[0];
       return (b(0) + t * (b(1) + t * b(2))) / (1.0 + t * (b(3) + t * b(4)));
     }},
    {"Hahn1", cubic_over_cubic},
    {"Nelson",  // of the logarithm of y
     [](const VectorXd& b, const double* x) {
       return b(0) - b(1) * x[0] * std::exp(-b(2) * x[1]);
     }},
    {"MGH17",
     [](const VectorXd& b, const double* x) {
       return b(0) + b(1) * std::exp(-b(3) * x[0]) + b(2) * std::exp(-b(4) * x[0]);
     }},
    {"Lanczos1", lanczos},
    {"Lanczos2", lanczos},
    {"Gauss3", gauss},
    {"Misra1c",
     [](const VectorXd& b, const double* x) {
       return b(0) * (1.0 - 1.0 / std::sqrt(1.0 + 2.0 * b(1) * x[0]));
     }},
    {"Misra1d",
     [](const VectorXd& b, const double* x) { return b(0) * b(1) * x[0] / (1.0 + b(1) * x[0]); }},
    {"Roszman1",
     [](const VectorXd& b, const double* x) {
       return b(0) - b(1) * x[0] - std::atan(b(2) / (x[0] - b(3))) / std::numbers::pi;
     }},
    {"ENSO",
     [](const VectorXd& b, const double* x) {
       return b(0) + cycle(b(1), b(2), 12.0, x[0]) + cycle(b(4), b(5), b(3), x[0]) +
              cycle(b(7), b(8), b(6), x[0]);
     }},
    // higher
    {"MGH09",
     [](const VectorXd& b, const double* x) {
       const double t = x[0];
       return b(0) * t * (t + b(1)) / (t * (t + b(2)) + b(3));
     }},
    {"Thurber", cubic_over_cubic},
    {"BoxBOD", saturation},
    {"Rat42", [](const VectorXd& b,
                 const double* x) { return b(0) / (1.0 + std::exp(b(1) - b(2) * x[0])); }},
    {"MGH10",
     [](const VectorXd& b, const double* x) { return b(0) * std::exp(b(1) / (x[0] + b(2))); }},
    {"Eckerle4",
     [](const VectorXd& b, const double* x) {
       return b(0) / b(1) * std::exp(-0.5 * square((x[0] - b(2)) / b(1)));
     }},
    {"Rat43",
     [](const VectorXd& b, const double* x) {
       return b(0) / std::pow(1.0 + std::exp(b(1) - b(2) * x[0]), 1.0 / b(3));
     }},
    {"Bennett5",
     [](const VectorXd& b, const double* x) { return b(0) * std::pow(b(1) + x[0], -1.0 / b(2)); }},
};

/// What one file of NIST's holds.
struct Dataset {
  std::vector<double> y;
  std::vector<std::vector<double>> x;
  VectorXd start[2], certified, certified_sigma;
  double certified_sum_of_squares = 0.0;
};

std::vector<double> numbers(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<double>(stream), {}};
}

/// Lines "b1 = start1 start2 certified sigma", "Residual Sum of Squares: s", and, below the last
/// line that begins with "Data:", y and its predictors.
Dataset read(const std::filesystem::path& path) {
  std::ifstream file(path);
  Dataset data;
  std::vector<std::vector<double>> parameters;
  bool in_data = false;
  for (std::string line; std::getline(file, line);) {
    const std::string sum = "Residual Sum of Squares:";
    const std::size_t first = line.find_first_not_of(' '), equals = line.find('=');
    if (line.starts_with("Data:")) {
      in_data = !parameters.empty();
    } else if (line.starts_with(sum)) {
      data.certified_sum_of_squares = numbers(line.substr(sum.size())).at(0);
    } else if (in_data) {
      const std::vector<double> row = numbers(line);
      if (row.size() < 2) continue;
      data.y.push_back(row[0]);
      data.x.emplace_back(row.begin() + 1, row.end());
    } else if (first != std::string::npos && equals != std::string::npos && line[first] == 'b' &&
               line.find_first_not_of("0123456789 ", first + 1) == equals) {
      parameters.push_back(numbers(line.substr(equals + 1)));
    }
  }
  const auto column = [&](std::size_t which) {
    VectorXd values(static_cast<Index>(parameters.size()));
    for (std::size_t j = 0; j < parameters.size(); ++j) {
      values(static_cast<Index>(j)) = parameters[j].at(which);
    }
    return values;
  };
  data.start[0] = column(0);
  data.start[1] = column(1);
  data.certified = column(2);
  data.certified_sigma = column(3);
  return data;
}

LeastSquaresProblem problem_of(const Reference& reference, const Dataset& data, int start) {
  LeastSquaresProblem problem;
  problem.start = data.start[start];
  problem.n_residuals = static_cast<Index>(data.y.size());
  const bool logarithmic = std::string(reference.name) == "Nelson";
  problem.residuals = [&data, formula = reference.formula, logarithmic](const VectorXd& b,
                                                                        VectorXd& residuals) {
    for (std::size_t i = 0; i < data.y.size(); ++i) {
      const double y = logarithmic ? std::log(data.y[i]) : data.y[i];
      residuals(static_cast<Index>(i)) = y - formula(b, data.x[i].data());
    }
    return true;
  };
  return problem;
}

/// Number of leading digits that agree, at most the 11 that NIST certifies.
double digits(double value, double certified) {
  const double error = std::abs(value - certified) / std::abs(certified);
  return error > 0.0 ? std::min(11.0, -std::log10(error)) : 11.0;
}

double digits(const VectorXd& value, const VectorXd& certified) {
  double least = 11.0;
  for (Index j = 0; j < value.size(); ++j) least = std::min(least, digits(value(j), certified(j)));
  return least;
}

/// Some starts lie where exp() overflows; the fit is to see that and step back.
class NoTraps {
 public:
  NoTraps() : before_(fedisableexcept(FE_ALL_EXCEPT)) {}
  ~NoTraps() {
    std::feclearexcept(FE_ALL_EXCEPT);
    feenableexcept(before_);
  }
  NoTraps(const NoTraps&) = delete;
  NoTraps& operator=(const NoTraps&) = delete;

 private:
  int before_;
};

class NistStrd : public ::testing::TestWithParam<Reference> {};

TEST_P(NistStrd, ComesToTheCertifiedParametersFromBothStarts) {
  const Reference& reference = GetParam();
  const std::filesystem::path path = std::filesystem::path(test_paths::source) / "tests" / "data" /
                                     "nist_strd" / (std::string(reference.name) + ".dat");
  ASSERT_TRUE(std::filesystem::exists(path)) << path;
  const NoTraps no_traps;
  const Dataset data = read(path);
  for (const int start : {0, 1}) {
    const auto found = fit_from_many_starts(problem_of(reference, data, start));
    ASSERT_TRUE(found);
    const LeastSquaresFit& fit = found->best;
    const double of_parameters = digits(fit.parameters, data.certified);
    const auto sigma = fit.scaled_sigma();
    ASSERT_TRUE(sigma);
    const double of_sigma = digits(*sigma, data.certified_sigma);
    RecordProperty("parameter_digits_from_start_" + std::to_string(start + 1),
                   std::to_string(of_parameters));
    EXPECT_GE(of_parameters, 6.0) << "start " << start + 1;
    // The residuals of Lanczos1 are 1e-13 of data around 1: rounding to 1e-16 leaves 3 digits of
    // them.
    EXPECT_GE(of_sigma, std::string(reference.name) == "Lanczos1" ? 2.0 : 4.0)
        << "start " << start + 1;
    EXPECT_TRUE(fit.converged) << "start " << start + 1;
  }
}

INSTANTIATE_TEST_SUITE_P(AllProblems, NistStrd, ::testing::ValuesIn(kReferences),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace manoscope::numerics
