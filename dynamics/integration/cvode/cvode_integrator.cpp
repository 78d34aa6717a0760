#include "dynamics/integration/cvode/cvode_integrator.h"

#include <cvode/cvode.h>
#include <fmt/format.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/integration/attempt.h"
#include "dynamics/integration/throw_stopped.h"
#include "dynamics/integration/touch_search.h"
#include "tools/support/dense/vector_span.h"
#include "tools/support/errors/numerical_error.h"

namespace sprung::dynamics {

// What CVODE's callbacks are given.
struct CvodeCallback {
  OdeSystem* system;
  double relative_tolerance;
  std::vector<double> limited;  // work space: error scales that accelerations limit
};

namespace {

// Steps below this mean that the solution cannot be continued: without a limit CVODE creeps towards a
// singular position for ever.
constexpr double kShortestStep = 1e-12;     // s
constexpr double kSwitchTolerance = 1e-12;  // s
constexpr double kRounding = 1e-13;         // of a value; accelerations of vibration get no closer to theirs
constexpr double kDifference = 1e-7;        // of the natural size of a component, for the Jacobian

std::span<double> values(N_Vector vector) {
  return {N_VGetArrayPointer(vector), static_cast<std::size_t>(NV_LENGTH_S(vector))};
}

int evaluate_derivative(sunrealtype time, N_Vector y, N_Vector y_dot, void* data) {
  const auto* callback = static_cast<CvodeCallback*>(data);
  return callback->system->calc_derivative(time, values(y), values(y_dot)) ? 0 : 1;
}

int evaluate_switches(sunrealtype time, N_Vector y, sunrealtype* switches, void* data) {
  const auto* callback = static_cast<CvodeCallback*>(data);
  const std::span<double> result(switches, static_cast<std::size_t>(callback->system->num_switches()));
  return callback->system->calc_switches(time, values(y), result) ? 0 : -1;
}

int evaluate_weights(N_Vector y, N_Vector weights, void* data) {
  auto* callback = static_cast<CvodeCallback*>(data);
  const double tolerance = callback->relative_tolerance;
  std::vector<double>& limited = callback->limited;
  callback->system->calc_error_scales(values(y), values(weights));
  std::copy(values(weights).begin(), values(weights).end(), limited.begin());
  callback->system->limit_to_accelerations(values(y), limited);
  for (std::size_t i = 0; i < limited.size(); ++i) {
    double& weight = values(weights)[i];
    if (!(weight > 0.0)) return -1;
    const double rounding = kRounding * std::abs(values(y)[i]);
    weight = 1.0 / std::max(tolerance * limited[i], std::min(tolerance * weight, rounding));
  }
  return 0;
}

// The Jacobian by differences of natural size: CVODE's own are as small as the errors allowed, which for
// stiff modes are far below what their accelerations resolve.
int evaluate_jacobian(sunrealtype time, N_Vector y, N_Vector y_dot, SUNMatrix jacobian, void* data,
                      N_Vector moved, N_Vector changed, N_Vector sizes) {
  auto* callback = static_cast<CvodeCallback*>(data);
  callback->system->calc_error_scales(values(y), values(sizes));
  std::copy(values(y).begin(), values(y).end(), values(moved).begin());
  for (sunindextype j = 0; j < NV_LENGTH_S(y); ++j) {
    double& component = values(moved)[static_cast<std::size_t>(j)];
    const double before = component;
    component += kDifference * std::max(std::abs(before), values(sizes)[static_cast<std::size_t>(j)]);
    const double difference = component - before;
    if (!callback->system->calc_derivative(time, values(moved), values(changed))) return 1;
    component = before;
    double* column = SUNDenseMatrix_Column(jacobian, j);
    for (std::size_t i = 0; i < values(changed).size(); ++i)
      column[i] = (values(changed)[i] - values(y_dot)[i]) / difference;
  }
  return 0;
}

// A context without MPI, and CVODE kept from printing errors that are thrown: the two calls that differ
// between the versions of SUNDIALS.
#if SUNDIALS_VERSION_MAJOR >= 7
int create_context(SUNContext* context) {
  return SUNContext_Create(SUN_COMM_NULL, context);
}
int stop_printing(SUNContext context, void* /*cvode*/) {
  return SUNContext_ClearErrHandlers(context);
}
#else
int create_context(SUNContext* context) {
  return SUNContext_Create(nullptr, context);
}
int stop_printing(SUNContext /*context*/, void* cvode) {
  return CVodeSetErrFile(cvode, nullptr);
}
#endif

std::string name_of(int code) {
  const std::unique_ptr<char, decltype(&std::free)> name(CVodeGetReturnFlagName(code), &std::free);
  return fmt::format("code {}, {}", code, name ? name.get() : "unknown");
}

std::string explain_stop(int code) {
  switch (code) {
    case CV_TOO_MUCH_ACC:
      return "the relative tolerance is finer than rounding allows this method; try a larger one, or "
             "method = \"exponential\"";
    case CV_CONV_FAILURE:
      return "the iteration of a step does not converge; look at forces and positions just before that "
             "time, and where springs or dampers are stiff try method = \"exponential\", or \"bdf\" in place "
             "of \"adams\"";
    case CV_ERR_FAILURE:
      return "the step has become too short; look at forces and positions just before that time, which may "
             "be a singular one, or take a larger tolerance";
    case CV_RHSFUNC_FAIL:
    case CV_FIRST_RHSFUNC_ERR:
    case CV_REPTD_RHSFUNC_ERR:
    case CV_UNREC_RHSFUNC_ERR:
    case CV_RTFUNC_FAIL:
      return "no accelerations can be found there; look at forces and positions just before that time";
    default:
      return name_of(code);
  }
}

}  // namespace

struct CvodeIntegrator::Memory {
  SUNContext context = nullptr;
  void* cvode = nullptr;
  N_Vector y = nullptr;
  SUNMatrix matrix = nullptr;
  SUNLinearSolver linear_solver = nullptr;
  SUNNonlinearSolver nonlinear_solver = nullptr;
  CvodeCallback callback;
  bool started = false;
  TouchSearch touch_search{0};
  Eigen::VectorXd begin_switches, end_switches;  // at the ends of the step
  Eigen::VectorXd between;                       // y within the step
  Integrator::Statistics before;                 // of the runs before the last restart

  void check(int code, const char* what) const {
    if (code >= 0) return;
    throw support::NumericalError(fmt::format("integrator: {} failed ({})", what, name_of(code)));
  }
  template <class Pointer>
  Pointer require(Pointer pointer, const char* what) const {
    if (!pointer) throw support::NumericalError(fmt::format("integrator: {} failed", what));
    return pointer;
  }
  ~Memory() {
    if (cvode) CVodeFree(&cvode);
    if (nonlinear_solver) SUNNonlinSolFree(nonlinear_solver);
    if (linear_solver) SUNLinSolFree(linear_solver);
    if (matrix) SUNMatDestroy(matrix);
    if (y) N_VDestroy(y);
    if (context) SUNContext_Free(&context);
  }
};

CvodeIntegrator::CvodeIntegrator(OdeSystem& system, const Options& options)
    : memory_(std::make_unique<Memory>()) {
  Memory& memory = *memory_;
  memory.callback = {&system, options.relative_tolerance,
                     std::vector<double>(static_cast<std::size_t>(system.size()))};
  memory.check(create_context(&memory.context), "SUNContext_Create");
  const bool adams = options.method == Method::kAdams;
  memory.y = memory.require(N_VNew_Serial(system.size(), memory.context), "N_VNew_Serial");
  N_VConst(0.0, memory.y);
  memory.cvode = memory.require(CVodeCreate(adams ? CV_ADAMS : CV_BDF, memory.context), "CVodeCreate");
  memory.check(stop_printing(memory.context, memory.cvode), "turning off messages");
  memory.check(CVodeInit(memory.cvode, evaluate_derivative, 0.0, memory.y), "CVodeInit");
  memory.check(CVodeSetUserData(memory.cvode, &memory.callback), "CVodeSetUserData");
  memory.check(CVodeSetMinStep(memory.cvode, kShortestStep), "CVodeSetMinStep");
  memory.check(CVodeWFtolerances(memory.cvode, evaluate_weights), "CVodeWFtolerances");
  if (adams) {
    memory.nonlinear_solver =
        memory.require(SUNNonlinSol_FixedPoint(memory.y, 0, memory.context), "SUNNonlinSol_FixedPoint");
    memory.check(CVodeSetNonlinearSolver(memory.cvode, memory.nonlinear_solver), "CVodeSetNonlinearSolver");
  } else {
    memory.matrix =
        memory.require(SUNDenseMatrix(system.size(), system.size(), memory.context), "SUNDenseMatrix");
    memory.linear_solver =
        memory.require(SUNLinSol_Dense(memory.y, memory.matrix, memory.context), "SUNLinSol_Dense");
    memory.check(CVodeSetLinearSolver(memory.cvode, memory.linear_solver, memory.matrix),
                 "CVodeSetLinearSolver");
    memory.check(CVodeSetJacFn(memory.cvode, evaluate_jacobian), "CVodeSetJacFn");
  }
  if (system.num_switches() > 0) {
    memory.check(CVodeRootInit(memory.cvode, system.num_switches(), evaluate_switches), "CVodeRootInit");
    memory.check(CVodeSetNoInactiveRootWarn(memory.cvode), "CVodeSetNoInactiveRootWarn");
    memory.touch_search = TouchSearch(system.num_switches());
    memory.begin_switches = memory.end_switches = Eigen::VectorXd::Zero(system.num_switches());
    memory.between = Eigen::VectorXd::Zero(system.size());
  }
}

CvodeIntegrator::~CvodeIntegrator() = default;

void CvodeIntegrator::start(double time, std::span<const double> y, double end_time) {
  Memory& memory = *memory_;
  if (memory.started) {
    memory.before = statistics();
    ++memory.before.restarts;
  }
  memory.started = true;
  std::copy(y.begin(), y.end(), values(memory.y).begin());
  memory.check(CVodeReInit(memory.cvode, time, memory.y), "CVodeReInit");
  memory.check(CVodeSetStopTime(memory.cvode, end_time), "CVodeSetStopTime");
  time_ = time;
  end_time_ = end_time;
  memory.touch_search.forget();
  calc_switches(time_, values(memory.y), memory.end_switches);
}

void CvodeIntegrator::calc_switches(double time, std::span<const double> y, Eigen::VectorXd& switches) {
  if (switches.size() == 0) return;
  if (memory_->callback.system->calc_switches(time, y, support::as_span(switches))) return;
  throw_stopped(time, "no positions can be found there");
}

// CVODE evaluates switches at the ends of a step: a function that becomes negative and positive again within
// the step is found here. y and time_ are at its first zero then.
bool CvodeIntegrator::locate_touch(double from) {
  Memory& memory = *memory_;
  if (memory.end_switches.size() == 0) return false;
  const double to = time_, length = to - from;
  memory.begin_switches.swap(memory.end_switches);
  calc_switches(to, values(memory.y), memory.end_switches);
  if (!(length > kShortestStep)) return false;
  const double tolerance = std::max(kSwitchTolerance, 4e-16 * std::abs(to)) / length;
  bool has_left = false;  // the end of the step
  const auto evaluate_at = [&](double place, Eigen::VectorXd& switches) {
    has_left = true;
    interpolate(from + place * length, support::as_span(memory.between));
    calc_switches(from + place * length, support::as_span(memory.between), switches);
  };
  const auto search = [&] {
    return memory.touch_search.find(memory.begin_switches, memory.end_switches, length, tolerance,
                                    evaluate_at);
  };
  const auto go_back = [&] {
    if (has_left) calc_switches(to, values(memory.y), memory.end_switches);
  };
  const std::optional<double> theta = attempt_or_go_back(search, go_back);
  if (!theta) return false;
  time_ = from + *theta * length;
  interpolate(time_, values(memory.y));
  return true;
}

Integrator::StepResult CvodeIntegrator::step(double longest_step) {
  Memory& memory = *memory_;
  if (end_time_ - time_ <= kShortestStep) return StepResult::kEnded;  // restarted by a switch at the very end
  memory.check(CVodeSetMaxStep(memory.cvode, std::isfinite(longest_step) ? longest_step : 0.0),
               "CVodeSetMaxStep");
  const double from = time_;
  const int code = CVode(memory.cvode, end_time_, memory.y, &time_, CV_ONE_STEP);
  if (code < 0) {
    throw_stopped(time_, explain_stop(code));
  }
  if (code == CV_ROOT_RETURN || locate_touch(from)) return StepResult::kSwitched;
  return code == CV_TSTOP_RETURN || time_ >= end_time_ ? StepResult::kEnded : StepResult::kStepped;
}

std::span<const double> CvodeIntegrator::y() const {
  return values(memory_->y);
}

void CvodeIntegrator::interpolate(double time, std::span<double> y) const {
  Memory& memory = *memory_;
  N_Vector target = memory.require(
      N_VMake_Serial(static_cast<sunindextype>(y.size()), y.data(), memory.context), "N_VMake_Serial");
  const int code = CVodeGetDky(memory.cvode, time, 0, target);
  N_VDestroy(target);
  memory.check(code, "CVodeGetDky");
}

Integrator::Statistics CvodeIntegrator::statistics() const {
  Statistics total = memory_->before;
  long steps = 0, error_failures = 0, iteration_failures = 0;
  const Memory& memory = *memory_;
  memory.check(CVodeGetNumSteps(memory.cvode, &steps), "CVodeGetNumSteps");
  memory.check(CVodeGetNumErrTestFails(memory.cvode, &error_failures), "CVodeGetNumErrTestFails");
  memory.check(CVodeGetNumNonlinSolvConvFails(memory.cvode, &iteration_failures),
               "CVodeGetNumNonlinSolvConvFails");
  total.steps += steps;
  total.error_test_failures += error_failures;
  total.iteration_failures += iteration_failures;
  return total;
}

}  // namespace sprung::dynamics
