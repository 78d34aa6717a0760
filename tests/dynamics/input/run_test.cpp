#include "dynamics/input/run.h"

#include <limits>

#include "dynamics/input/make_model.h"
#include "dynamics/road/flat_road.h"
#include "tests/catch.h"
#include "tests/dynamics/input/input_cases.h"

using namespace sprung;
using test::input_error_of;

namespace {

const std::string kText = R"(vehicle = "cart.toml"
speed = 3.0
duration = 5.0
output_step = 2e-3
start = "as-given"

[modes]
frame = 2

[modal_damping]
frame = 0.05

[statistics]
from = 0.5
to = 4.5

[road]
shape = "ramp"
start = 1.0
length = 0.4
height = 0.2

[integrator]
method = "bdf"
relative_tolerance = 1e-8
largest_step = 0.01

[output]
points = ["arm.tip", "frame.top", "arm.tip"]

[initial.frame]
velocity = [0.5, -0.25]
angular_velocity = 2.0
modal_amplitude = [0.01, 0.02]
modal_rate = [0.3, 0.4]
)";

dynamics::Run read(const std::string& text) {
  return dynamics::read_run(support::TomlDocument::parse(text, "runs/first.toml"));
}

std::string error_of(const std::string& old_part, const std::string& new_part) {
  return input_error_of([&] { read(test::with_change(kText, old_part, new_part)); });
}

}  // namespace

TEST_CASE("A run file is read as it is written, its paths relative to its folder") {
  const dynamics::Run run = read(kText);
  CHECK(run.text == kText);
  CHECK(run.vehicle_path == "runs/cart.toml");
  CHECK(run.speed == 3.0);
  CHECK(run.duration == 5.0);
  CHECK(run.output_step == 2e-3);
  CHECK(run.start == dynamics::Run::Start::kAsGiven);
  CHECK(run.statistics_from == 0.5);
  CHECK(run.statistics_to == 4.5);
  CHECK(run.integrator.options.method == dynamics::SteppingMethod::kBdf);
  CHECK(run.integrator.options.relative_tolerance == 1e-8);
  CHECK(run.integrator.largest_step == 0.01);
  CHECK(dynamics::make_road(run.road)->height(2.0) == 0.2);
  const dynamics::Vehicle cart = test::read_cart(test::cart_text());
  const dynamics::ModeSelection selection = dynamics::resolve_modes(run, cart);
  CHECK(selection.at("frame") == std::vector<int>{1, 2});
  CHECK(dynamics::resolve_modal_damping(run.modal_damping, selection, cart).at("frame") ==
        std::vector<double>{0.05});
  CHECK(dynamics::resolve_output_points(run, cart) == std::vector<std::string>{"arm.tip", "frame.top"});
}

TEST_CASE("Only vehicle and duration are needed") {
  const dynamics::Run run = read("vehicle = \"/models/cart.toml\"\nduration = 2.0\n");
  CHECK(run.vehicle_path == "/models/cart.toml");
  CHECK(run.speed == 0.0);
  CHECK(run.output_step == 1e-3);
  CHECK(run.start == dynamics::Run::Start::kEquilibrium);
  CHECK(run.statistics_from == 0.0);
  CHECK(run.statistics_to == 2.0);
  CHECK_FALSE(run.integrator.names_method);
  CHECK(run.integrator.options.relative_tolerance == 1e-6);
  CHECK(run.integrator.largest_step == std::numeric_limits<double>::infinity());
  CHECK(dynamics::make_road(run.road)->height(2.0) == 0.0);
  const dynamics::Vehicle cart = test::read_cart(test::cart_text());
  CHECK(dynamics::resolve_modes(run, cart).empty());
  CHECK(dynamics::resolve_output_points(run, cart) == std::vector<std::string>{"frame.seat", "arm.tip"});
}

TEST_CASE("The start of a run is the speed along the heading and what is given for single bodies") {
  const dynamics::Run run = read(kText);
  const dynamics::FlatRoad flat;
  for (const double direction : {1.0, -1.0}) {
    dynamics::Vehicle cart = test::read_cart(test::cart_text());
    cart.direction = direction;
    const dynamics::Model model = dynamics::make_model(cart, {{"frame", {1, 2}}}, {.road = &flat});
    Eigen::VectorXd expected(8);  // frame: x, y, angle, two modes; arm: x, y, angle
    expected << 3.0 * direction + 0.5, -0.25, 2.0, 0.3, 0.4, 3.0 * direction, 0.0, 0.0;
    CHECK(dynamics::make_start_velocities(run, cart, model) == expected);
    Eigen::VectorXd q = dynamics::make_start_positions(model, cart);
    dynamics::add_initial_amplitudes(run, model, q);
    expected << 2.0, 1.0, 0.3, 0.01, 0.02, 3.5, 0.9, 0.0;
    CHECK(q == expected);
  }
}

TEST_CASE("Initial motion of missing bodies or modes is refused") {
  const dynamics::Vehicle cart = test::read_cart(test::cart_text());
  const dynamics::FlatRoad flat;
  const dynamics::Model rigid = dynamics::make_model(cart, {}, {.road = &flat});
  Eigen::VectorXd q = dynamics::make_start_positions(rigid, cart);
  CHECK(input_error_of([&] { dynamics::add_initial_amplitudes(read(kText), rigid, q); }) ==
        "runs/first.toml:31:1: error: 'initial.frame.modal_amplitude' must be one number for each of the 0 "
        "available modes, got 2");
  CHECK(input_error_of([&] { dynamics::make_start_velocities(read(kText), cart, rigid); }) ==
        "runs/first.toml:31:1: error: 'initial.frame.modal_rate' must be one number for each of the 0 "
        "available modes, got 2");
  const dynamics::Run other = read(test::with_change(kText, "[initial.frame]", "[initial.frome]"));
  CHECK(
      input_error_of([&] { dynamics::make_start_velocities(other, cart, rigid); }) ==
      "runs/first.toml:31:1: error: 'initial.frome' is about no body of the vehicle (did you mean 'frame'?)");
}

TEST_CASE("Available modes of a missing body are refused, also without adaptivity") {
  const dynamics::Vehicle cart = test::read_cart(test::cart_text());
  const std::string text = test::with_change(kText, "[modes]", "[adaptivity.available]\nframo = 1\n[modes]");
  for (const char* enabled : {"", "[adaptivity]\nenabled = true\n"}) {
    const dynamics::Run run = read(
        test::with_change(text, "[adaptivity.available]", enabled + std::string("[adaptivity.available]")));
    const std::string error = input_error_of([&] { dynamics::resolve_available_modes(run, {}, cart); });
    CHECK(error.ends_with(
        "error: 'adaptivity.available.framo' is about no body of the vehicle: there is no 'framo' (did you "
        "mean 'frame'?)"));
  }
}

TEST_CASE("Keys of a run that are missing, unknown or of the wrong type are refused") {
  CHECK(error_of("vehicle = \"cart.toml\"\n", "") == "runs/first.toml: error: missing key 'vehicle'");
  CHECK(error_of("vehicle = \"cart.toml\"\n", "[bodies.cart]\nmass = 1.0\n")
            .find("error: 'bodies' belongs to a vehicle file, expected a run file") != std::string::npos);
  CHECK(error_of("duration = 5.0\n", "") == "runs/first.toml: error: missing key 'duration'");
  CHECK(error_of("[modes]", "[adaptivity.available]\nframe = \"auto\"\n[modes]") ==
        "runs/first.toml:8:9: error: 'adaptivity.available.frame' must be a number of modes, a list of "
        "mode numbers or \"all\"; \"auto\" chooses from what is available, in [modes]");
  CHECK(error_of("speed =", "sped =") ==
        "runs/first.toml:2:1: error: unknown key 'sped' (did you mean 'speed'?)");
  CHECK(error_of("speed = 3.0", "speed = \"3 m/s\"") ==
        "runs/first.toml:2:9: error: 'speed' must be a number [m/s], got a string \"3 m/s\"");
  CHECK(error_of("start = \"as-given\"", "start = \"as_given\"") ==
        "runs/first.toml:5:9: error: 'start' must be one of \"equilibrium\", \"steady\", \"as-given\"; got "
        "a string \"as_given\" (did you mean 'as-given'?)");
  CHECK(error_of("method = \"bdf\"", "method = \"bfd\"") ==
        "runs/first.toml:24:10: error: 'integrator.method' must be one of \"exponential\", "
        "\"generalized-alpha\", \"adams\", \"bdf\"; got a string \"bfd\" (did you mean 'bdf'?)");
  CHECK(error_of("from = 0.5", "form = 0.5") ==
        "runs/first.toml:14:1: error: unknown key 'form' in 'statistics' (did you mean 'from'?)");
  CHECK(error_of("largest_step", "max_step") ==
        "runs/first.toml:26:1: error: unknown key 'max_step' in 'integrator' (known keys: method, "
        "relative_tolerance, largest_step, spectral_radius, fixed_step)");
  CHECK(error_of("angular_velocity", "angular_speed") ==
        "runs/first.toml:33:1: error: unknown key 'angular_speed' in 'initial.frame' (known keys: velocity, "
        "angular_velocity, modal_amplitude, modal_rate)");
  CHECK(error_of("points = [\"arm.tip\", \"frame.top\", \"arm.tip\"]", "point = [\"arm.tip\"]") ==
        "runs/first.toml:29:1: error: unknown key 'point' in 'output' (did you mean 'points'?)");
}

TEST_CASE("Inconsistent times are refused") {
  CHECK(error_of("duration = 5.0", "duration = -5.0") ==
        "runs/first.toml:3:12: error: 'duration' must be ≥ 1e-09 s, got -5");
  CHECK(error_of("duration = 5.0", "duration = inf") ==
        "runs/first.toml:3:12: error: 'duration' must be a finite number [s], got inf");
  CHECK(error_of("output_step = 2e-3", "output_step = 6.0") ==
        "runs/first.toml:4:15: error: 'output_step' of 6 s must be at most the duration of 5 s");
  CHECK(error_of("output_step = 2e-3", "output_step = 1e-7") ==
        "runs/first.toml:4:15: error: 'output_step' of 1e-07 s gives 5e+07 outputs in 5 s, must be at most "
        "1e+07");
  CHECK(error_of("output_step = 2e-3\n", "").find("no error") == 0);
  CHECK(error_of("to = 4.5", "to = 5.5") ==
        "runs/first.toml:15:6: error: 'statistics.to' must be ≥ 0 and ≤ 5 s, got 5.5");
  CHECK(error_of("from = 0.5", "from = 4.5") ==
        "runs/first.toml:13:1: error: 'statistics' must end after it begins, got from 4.5 s to 4.5 s");
}

TEST_CASE("What is run but not put out is said") {
  const auto describe = [](const std::string& times, double start) {
    return dynamics::describe_early_end(
        dynamics::read_run(support::TomlDocument::parse("vehicle = \"v.toml\"\n" + times, "run.toml")),
        start);
  };
  CHECK(describe("duration = 1.0\noutput_step = 0.6\n", 0.0) ==
        "run.toml:2:12: the last output is at 0.6 s, and what the vehicle does up to 1 s is not put out: the "
        "duration is no multiple of the output_step of 0.6 s");
  CHECK(describe("duration = 1.0\noutput_step = 0.6\n", 0.4).empty());
  CHECK(describe("duration = 1.0\noutput_step = 0.1\n", 0.45).find("last output is at 0.95 s") !=
        std::string::npos);
  for (const char* even : {"duration = 13.0\noutput_step = 0.001\n",
                           "duration = 4.0\noutput_step = 0.003125\n", "duration = 0.3\noutput_step = 0.1\n"})
    CHECK(describe(even, 0.0).empty());
}

TEST_CASE("Settings of the integrator out of range are refused") {
  CHECK(error_of("relative_tolerance = 1e-8", "relative_tolerance = 1e-15") ==
        "runs/first.toml:25:22: error: 'integrator.relative_tolerance' must be ≥ 1e-13 and ≤ 0.1, got 1e-15");
  CHECK(error_of("relative_tolerance = 1e-8", "relative_tolerance = 0.5") ==
        "runs/first.toml:25:22: error: 'integrator.relative_tolerance' must be ≥ 1e-13 and ≤ 0.1, got 0.5");
  CHECK(error_of("largest_step = 0.01", "largest_step = 0.0") ==
        "runs/first.toml:26:16: error: 'integrator.largest_step' must be ≥ 5e-09 s, got 0");
  const std::string alpha = "method = \"generalized-alpha\"\n";
  CHECK(error_of("method = \"bdf\"\n", alpha + "spectral_radius = 1.1\n") ==
        "runs/first.toml:25:19: error: 'integrator.spectral_radius' must be ≥ 0 and ≤ 1, got 1.1");
  CHECK(error_of("method = \"bdf\"\n", alpha + "fixed_step = 0\n") ==
        "runs/first.toml:25:14: error: 'integrator.fixed_step' must be ≥ 5e-09 s, got 0");
  CHECK(error_of("largest_step = 0.01", "fixed_step = 0.01") ==
        "runs/first.toml:26:14: error: 'integrator.fixed_step' has a meaning with method = "
        "\"generalized-alpha\" only");
}

TEST_CASE("Generalized-α takes a spectral radius and a fixed step") {
  const dynamics::Run run =
      read(test::with_change(kText, "method = \"bdf\"\n",
                             "method = \"generalized-alpha\"\nspectral_radius = 0.6\nfixed_step = 1e-4\n"));
  CHECK(run.integrator.options.method == dynamics::SteppingMethod::kGeneralizedAlpha);
  CHECK(run.integrator.options.generalized_alpha.spectral_radius == 0.6);
  CHECK(run.integrator.options.generalized_alpha.fixed_step == 1e-4);
}

TEST_CASE("Output points that the vehicle lacks are refused") {
  const dynamics::Vehicle cart = test::read_cart(test::cart_text());
  const dynamics::Run run = read(test::with_change(kText, "\"frame.top\"", "\"frame.tob\""));
  CHECK(input_error_of([&] { dynamics::resolve_output_points(run, cart); }) ==
        "runs/first.toml:29:22: error: 'frame' has no point 'tob' (did you mean 'top'?)");
  CHECK(error_of("[\"arm.tip\", \"frame.top\", \"arm.tip\"]", "[]") ==
        "runs/first.toml:29:10: error: 'output.points' must name at least one point \"body.point\"; leave it "
        "out for those of the vehicle's 'monitor'");
}
