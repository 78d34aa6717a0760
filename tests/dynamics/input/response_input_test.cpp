#include "dynamics/input/response_input.h"

#include <string>

#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"

using namespace sprung;
using dynamics::ResponseRequest;

namespace {

ResponseRequest read(const std::string& text) {
  const auto document = support::TomlDocument::parse(text, "run.toml");
  return dynamics::read_response(*document.root().find_table("response"));
}

std::string error_of(const std::string& text) {
  return test::input_error_of([&] { read(text); });
}

}  // namespace

TEST_CASE("A response table with all defaults asks for 0.1 to 50 Hz and no road", "[input]") {
  const ResponseRequest request = read("[response]\n");
  CHECK_FALSE(request.road);
  CHECK(request.points.empty());
  const std::vector<double> frequencies = dynamics::list_frequencies(request);
  REQUIRE(frequencies.size() == 1000);
  CHECK(frequencies.front() == 0.1);
  CHECK(frequencies.back() == 50.0);
  CHECK(frequencies[600] / frequencies[599] == Approx(frequencies[1] / frequencies[0]).epsilon(1e-12));
}

TEST_CASE("Frequencies at equal distances", "[input]") {
  const std::vector<double> frequencies =
      dynamics::list_frequencies(read("response = { from = 1, to = 3, number = 5, spacing = \"linear\" }\n"));
  CHECK(frequencies == std::vector<double>{1.0, 1.5, 2.0, 2.5, 3.0});
}

TEST_CASE("Roads by class, by density, by points, cut to a band", "[input]") {
  CHECK(read("response.road.class = \"C\"").road->density(0.2) == Approx(64e-6).epsilon(1e-12));
  CHECK(read("response.road = { density = 1e-6, exponent = 3.0 }").road->density(1.0) ==
        Approx(1e-9).epsilon(1e-12));
  const ResponseRequest request =
      read("response.road = { table = [[0.1, 1e-4], [10.0, 1e-8]], band = [0.5, 2.0] }");
  CHECK(request.road->density(1.0) == Approx(1e-6).epsilon(1e-12));
  CHECK(request.road->density(0.4) == 0.0);
}

TEST_CASE("Wrong keys and values of a response table are refused at their location", "[input]") {
  CHECK_THAT(error_of("[response]\nfrom = 0\n"), Contains("run.toml:2:8: error: ") && Contains("Hz"));
  CHECK_THAT(error_of("[response]\nfrom = 60.0\n"), Contains("got from 60 Hz to 50 Hz"));
  CHECK_THAT(error_of("[response]\nnumber = 1\n"), Contains("run.toml:2:10: error: 'response.number'"));
  CHECK_THAT(error_of("[response]\nspacing = \"log\"\n"),
             Contains("run.toml:2:11: error: ") && Contains("linear"));
  CHECK_THAT(error_of("[response]\npoints = []\n"), Contains("at least one point"));
  CHECK_THAT(error_of("[response]\nfrm = 1\n"), Contains("run.toml:2:1: error: ") && Contains("from"));
  CHECK_THAT(error_of("[response.road]\nclass = \"I\"\n"), Contains("run.toml:2:9: error: "));
  CHECK_THAT(error_of("[response.road]\nband = [0, 1]\n"),
             Contains("either a 'class', or a 'density', or a 'table'"));
  CHECK_THAT(error_of("[response.road]\nclass = \"A\"\ndensity = 1.0\n"), Contains("not several of them"));
  CHECK_THAT(error_of("[response.road]\nclass = \"A\"\nexponent = 3.0\n"),
             Contains("run.toml:3:12: error: 'response.road.exponent' belongs to a power law, which 'class' "
                      "does not give"));
  CHECK_THAT(error_of("[response.road]\nclass = \"A\"\nband = [2.0, 1.0]\n"),
             Contains("must ascend, got 2 to 1 1/m"));
  CHECK_THAT(error_of("[response.road]\ntable = [[0.1, 1.0], [0.1, 2.0]]\n"), Contains("must ascend"));
  CHECK_THAT(error_of("[response.road]\ntable = [[0.1, 1.0], [0.2, 0.0]]\n"), Contains("m^3"));
}
