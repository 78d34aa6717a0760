#include "dynamics/output/parameter_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>

namespace sprung::dynamics {

namespace {

// The pieces of a function as a table: a row of coefficients for each of them, padded with zeros.
void write_pieces(support::Hdf5Writer& file, const std::string& group, const PiecewisePolynomial& function,
                  const Parameter& parameter) {
  const std::size_t pieces = function.num_pieces();
  std::size_t columns = 0;
  for (std::size_t i = 0; i < pieces; ++i) columns = std::max(columns, function.coefficients(i).size());
  Eigen::MatrixXd coefficients =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(pieces), static_cast<Eigen::Index>(columns));
  std::vector<double> origins;
  for (std::size_t i = 0; i < pieces; ++i) {
    origins.push_back(function.origin(i));
    const std::span<const double> row = function.coefficients(i);
    for (std::size_t k = 0; k < row.size(); ++k) {
      coefficients(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = row[k];
    }
  }
  file.write(group + "/breakpoints", function.breaks(), parameter.argument_unit);
  file.write(group + "/origins", origins, parameter.argument_unit);
  file.write(group + "/coefficients", coefficients,
             fmt::format("{} per ({})^column", parameter.unit, parameter.argument_unit));
  file.attribute(group, "unit", parameter.unit);
  file.attribute(group, "argument_unit", parameter.argument_unit);
}

// One overload for each kind of value.
struct ValueWriter {
  support::Hdf5Writer& file;
  const std::string& group;
  const Parameter& parameter;

  std::string path() const { return group + "/" + parameter.name; }
  void operator()(double value) const { write_number(file, group, parameter.name, value, parameter.unit); }
  void operator()(bool value) const { file.attribute(group, parameter.name, std::int64_t{value}); }
  void operator()(const std::string& value) const { file.attribute(group, parameter.name, value); }
  void operator()(const Eigen::Vector2d& value) const { file.write(path(), value, parameter.unit); }
  void operator()(const std::vector<double>& values) const {
    file.write(path(), std::span<const double>(values), parameter.unit);
  }
  void operator()(const PiecewisePolynomial& function) const {
    write_pieces(file, path(), function, parameter);
  }
  void operator()(const TimeFunction& function) const {
    write_pieces(file, path(), function.polynomials(), parameter);
    const std::span<const TimeFunction::Oscillation> oscillations = function.oscillations();
    if (oscillations.size() == 1 && oscillations[0].amplitude.is_constant()) {
      write_number(file, path(), "amplitude", oscillations[0].amplitude.value(0.0), parameter.unit);
      write_number(file, path(), "frequency", oscillations[0].frequency_hz, "Hz");
      write_number(file, path(), "phase", oscillations[0].phase, "rad");
      return;
    }
    std::size_t number = 0;
    for (const TimeFunction::Oscillation& one : oscillations) {
      const std::string oscillation = fmt::format("{}/oscillation_{}", path(), ++number);
      write_pieces(file, oscillation, one.amplitude, parameter);
      write_number(file, oscillation, "frequency", one.frequency_hz, "Hz");
      write_number(file, oscillation, "phase", one.phase, "rad");
    }
  }
};

}  // namespace

void write_number(support::Hdf5Writer& file, const std::string& group, const std::string& name, double value,
                  std::string_view unit) {
  file.attribute(group, name, value);
  file.attribute(group, name + "_unit", unit);
}

void write_description(support::Hdf5Writer& file, const std::string& group,
                       const ElementDescription& description) {
  file.attribute(group, "drawing", drawing_name(description.drawing));
  file.attribute(group, "on_road", std::int64_t{description.on_road});
  const std::string parameters = group + "/parameters";
  file.make_group(parameters);
  for (const Parameter& parameter : description.parameters) {
    std::visit(ValueWriter{file, parameters, parameter}, parameter.value);
  }
}

}  // namespace sprung::dynamics
