#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "fem/beam_model.h"

namespace sprung::fem::test {

/// Properties with no round number, shear deformation and rotary inertia.
BeamProperties make_thick_properties();

/// Properties with no round number, Euler–Bernoulli without rotary inertia.
BeamProperties make_thin_properties();

/// A frame in general pose: five nodes, a closed triangle with a tilted arm, both sections, two point masses.
BeamModel make_general_frame();

/// A straight beam of equal elements, one section.
BeamModel make_straight_beam(const Eigen::Vector2d& from, const Eigen::Vector2d& to, int num_elements,
                             const BeamProperties& properties);

/// The same model with its nodes in another order: node n of the model is node `order[n]` of the result.
BeamModel renumber(const BeamModel& model, const std::vector<int>& order);

/// Nodes and weights of five-point Gauss–Legendre quadrature on 0 … 1, exact to degree 9.
/// Source: Abramowitz & Stegun, table 25.4, moved from −1 … 1.
struct QuadraturePoint {
  double xi, weight;
};
std::vector<QuadraturePoint> make_quadrature();

/// Frequencies [Hz] of K φ = ω² M φ, ascending, by Eigen's dense solver in the form M φ = μ K φ.
/// @param K positive definite
Eigen::VectorXd calc_frequencies(const Eigen::MatrixXd& K, const Eigen::MatrixXd& M);

/// Rows and columns of `matrix` without the three dofs of `node`.
Eigen::MatrixXd remove_node(const Eigen::MatrixXd& matrix, int node);

/// Largest absolute entry of a − b, relative to the largest of b.
double calc_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// The file of that name in the folder of the tests.
std::filesystem::path get_data(std::string_view name);
std::string read_file(const std::filesystem::path& path);
/// Writes a file into the test's working directory. @return its path
std::filesystem::path write_file(std::string_view name, std::string_view text);
/// `text` with the first `from` replaced; the test fails if there is none.
std::string replace(std::string text, std::string_view from, std::string_view to);

/// The message of the InputError that `call` throws; the test fails if it throws none.
template <class Error, class Call>
std::string message_of(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

/// A Catch2 check that the message contains the text, the same under versions 2 and 3.
void check_contains(const std::string& message, std::string_view text);

}  // namespace sprung::fem::test
