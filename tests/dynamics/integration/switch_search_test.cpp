// Zeros of functions whose zeros are known.
#include "dynamics/integration/switch_search.h"

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "tests/catch.h"

using namespace sprung;
using Function = std::function<double(double)>;

namespace {

constexpr double kTolerance = 1e-11;

struct Search {
  double place = 0.0;
  int num_evaluations = 0;
};

// From the values at some places; functions cross between places[after − 1] and places[after]. Their signs
// are taken so that none is negative at the former.
Search locate(const std::vector<Function>& functions, const std::vector<double>& places, int after) {
  const auto fill = [&](double theta, auto&& values) {
    for (std::size_t i = 0; i < functions.size(); ++i)
      values[static_cast<Eigen::Index>(i)] =
          std::copysign(1.0, functions[i](places[static_cast<std::size_t>(after) - 1])) * functions[i](theta);
  };
  const auto n = static_cast<Eigen::Index>(functions.size());
  Eigen::MatrixXd values(n, static_cast<Eigen::Index>(places.size()));
  for (std::size_t j = 0; j < places.size(); ++j) fill(places[j], values.col(static_cast<Eigen::Index>(j)));
  dynamics::SwitchSearch search(n);
  Search result;
  result.place = search.locate(places, values, after, kTolerance, [&](double theta, Eigen::VectorXd& at) {
    ++result.num_evaluations;
    CHECK(theta >= places[static_cast<std::size_t>(after) - 1]);
    CHECK(theta <= places[static_cast<std::size_t>(after)]);
    fill(theta, at);
  });
  return result;
}

const std::vector<double> kFour = {0.0, 0.28, 0.72, 1.0};

}  // namespace

TEST_CASE("A point just behind the zero is found, for any shape of the function", "[analysis]") {
  struct Case {
    Function function;
    double zero;
    int most_evaluations;
  };
  const std::vector<Case> cases = {
      {[](double x) { return x - 0.5; }, 0.5, 2},
      {[](double x) { return 0.4 - x; }, 0.4, 2},
      {[](double x) { return std::cos(3.0 * x); }, std::acos(0.0) / 3.0, 4},
      {[](double x) { return std::exp(4.0 * x) - std::exp(2.4); }, 0.6, 6},
      {[](double x) { return (x - 0.45) * std::abs(x - 0.45); }, 0.45, 80},
      {[](double x) { return std::tanh(200.0 * (x - 0.3)); }, 0.3, 40},
      {[](double x) { return x < 0.6 ? -1.0 : 1.0; }, 0.6, 80},
      {[](double x) { return x < 0.6 ? x - 0.7 : x; }, 0.6, 80},
  };
  for (const Case& one : cases) {
    for (const std::vector<double>& places : {kFour, std::vector<double>{0.28, 0.72}}) {
      const Search search = locate({one.function}, places, places.size() == 4 ? 2 : 1);
      CAPTURE(one.zero, places.size(), search.num_evaluations);
      CHECK(search.place >= one.zero - 1e-15);
      CHECK(search.place <= one.zero + 10.0 * kTolerance);
      CHECK(one.function(search.place) * one.function(0.28) <= 0.0);
      if (places.size() == 4) CHECK(search.num_evaluations <= one.most_evaluations);
    }
  }
}

TEST_CASE("Of several functions the first zero counts", "[analysis]") {
  const Search search =
      locate({[](double x) { return std::sin(x - 0.61); }, [](double x) { return 0.4 - x * x; },
              [](double) { return 1.0; }, [](double x) { return x - 0.60999; }},
             kFour, 2);
  CHECK(search.place >= 0.60999);
  CHECK(search.place <= 0.60999 + 10.0 * kTolerance);
}

TEST_CASE("A function that starts at zero is found at its next zero", "[analysis]") {
  const Search search = locate({[](double x) { return x * (0.1 - x); }}, kFour, 1);
  CHECK(search.place >= 0.1 - 1e-15);
  CHECK(search.place <= 0.1 + 10.0 * kTolerance);
}

TEST_CASE("A function that is never positive ends at once", "[analysis]") {
  const Search search = locate({[](double x) { return 0.0 - x; }}, kFour, 1);
  CHECK(search.place <= 10.0 * kTolerance);
}

TEST_CASE("Only a function that becomes negative has a crossing", "[analysis]") {
  using dynamics::SwitchSearch;
  const Eigen::Vector2d before(0.0, 1.0);
  CHECK_FALSE(SwitchSearch::any_crosses(before, Eigen::Vector2d(1.0, 0.0)));
  CHECK(SwitchSearch::any_crosses(before, Eigen::Vector2d(-1.0, 1.0)));
  CHECK(SwitchSearch::any_crosses(before, Eigen::Vector2d(0.0, -0.5)));
}
