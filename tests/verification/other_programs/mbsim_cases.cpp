// The swinging beam and the chassis on springs for MBSim: a program of its C++ interface. Prints the rows of
// mbsim_pendulum.txt and mbsim_hung_chassis.txt.
//
//   mbsim_cases FILE_mbsim.h5 [FRONT REAR]     the nodes of the springs; without them the beam
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/numeric/odeint.hpp>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "mbsim/dynamic_system_solver.h"
#include "mbsim/environment.h"
#include "mbsim/frames/fixed_relative_frame.h"
#include "mbsim/functions/kinematics/kinematics.h"
#include "mbsim/functions/kinetics/kinetics.h"
#include "mbsim/links/spring_damper.h"
#include "mbsimFlexibleBody/flexible_body/external_flexible_ffr_body.h"
#include "mbsimFlexibleBody/frames/node_frame.h"

namespace {

using State = std::vector<double>;

class System {
 public:
  System(const std::string& name, const std::string& file, const std::vector<int>& spring_nodes,
         double gravity)
      : solver_(name) {
    fmatvec::Vec3 acceleration;
    acceleration(1) = -gravity;
    solver_.getMBSimEnvironment()->setAccelerationOfGravity(acceleration);
    auto* body = new MBSimFlexibleBody::ExternalFlexibleFfrBody("body");
    body->setInputDataFile(file);
    if (!spring_nodes.empty()) body->setTranslation(new MBSim::TranslationAlongAxesXY<fmatvec::VecV>);
    body->setRotation(new MBSim::RotationAboutZAxis<fmatvec::VecV>);
    solver_.addObject(body);
    const double place[] = {-2.175, 2.175}, stiffness[] = {8e5, 1.2e6};
    for (std::size_t i = 0; i < spring_nodes.size(); ++i) {
      const std::string number = std::to_string(i);
      fmatvec::Vec3 r;
      r(0) = place[i];
      r(1) = 1.0;
      auto* ground = new MBSim::FixedRelativeFrame("ground" + number, r, fmatvec::SqrMat3(fmatvec::EYE));
      solver_.addFrame(ground);
      auto* node = new MBSimFlexibleBody::NodeFrame("node" + number, spring_nodes[i]);
      body->addFrame(node);
      auto* spring = new MBSim::SpringDamper("spring" + number);
      spring->setUnloadedLength(1.0);
      spring->setForceFunction(new MBSim::LinearSpringDamperForce(stiffness[i], 0.0));
      spring->connect(ground, node);
      solver_.addLink(spring);
    }
    solver_.setPlotFeatureRecursive(MBSim::plotRecursive, false);
    solver_.initialize();
  }

  int size() { return solver_.getzSize(); }
  void operator()(const State& z, State& derivative, double time) {
    solver_.setTime(time);
    for (int i = 0; i < size(); ++i) solver_.getState()(i) = z[i];
    solver_.resetUpToDate();
    const fmatvec::Vec& found = solver_.evalzd();
    for (int i = 0; i < size(); ++i) derivative[i] = found(i);
  }

 private:
  MBSim::DynamicSystemSolver solver_;
};

// By central differences about rest.
void print_frequencies(System& system) {
  constexpr double kStep = 1e-6;
  const int n = system.size();
  Eigen::MatrixXd A(n, n);
  State above(n), below(n);
  for (int j = 0; j < n; ++j) {
    State z(n, 0.0);
    z[j] = kStep;
    system(z, above, 0.0);
    z[j] = -kStep;
    system(z, below, 0.0);
    for (int i = 0; i < n; ++i) A(i, j) = (above[i] - below[i]) / (2.0 * kStep);
  }
  const Eigen::VectorXcd values = A.eigenvalues();
  std::vector<double> frequencies;
  for (int i = 0; i < n; ++i) {
    if (values[i].imag() > 1e-3) frequencies.push_back(values[i].imag() / (2.0 * std::numbers::pi));
  }
  std::sort(frequencies.begin(), frequencies.end());
  std::printf("frequencies");
  for (const double frequency : frequencies) std::printf(" %.12g", frequency);
  std::printf("\n");
}

void print_motion(System& system, bool is_hinged) {
  constexpr double kTolerance = 1e-11;
  State z(system.size(), 0.0);
  std::vector<double> times;
  for (int i = 0; i <= 50; ++i) times.push_back(0.02 * i);
  namespace odeint = boost::numeric::odeint;
  odeint::integrate_times(
      odeint::make_controlled<odeint::runge_kutta_fehlberg78<State>>(kTolerance, kTolerance),
      [&](const State& at, State& derivative, double time) { system(at, derivative, time); }, z,
      times.begin(), times.end(), 1e-5,
      [&](const State& at, double time) {
        std::printf("%.2f%s", time, is_hinged ? " 0 0" : "");
        for (std::size_t i = 0; i < at.size() / 2; ++i) std::printf(" %.10g", at[i]);
        std::printf("\n");
      });
}

}  // namespace

int main(int argc, char** argv) {
  const std::string file = argv[1];
  std::vector<int> nodes;
  for (int i = 2; i < argc; ++i) nodes.push_back(std::stoi(argv[i]));
  System at_rest("at_rest", file, nodes, 0.0);
  print_frequencies(at_rest);
  System moving("moving", file, nodes, 9.81);
  print_motion(moving, nodes.empty());
}
