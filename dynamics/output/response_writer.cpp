#include "dynamics/output/response_writer.h"

#include <cstdint>

#include "tools/support/hdf5/hdf5_file.h"

namespace sprung::dynamics {

namespace {

std::string per_metre(const std::string& unit) {
  return unit == "m" ? "1" : unit + "/m";
}

void write_inputs(support::Hdf5Writer& file, const ResponseResult& result) {
  std::vector<std::string> names;
  std::vector<double> distance;
  std::vector<std::int64_t> pressed;
  for (const RoadInput& input : result.inputs) {
    names.push_back(input.name);
    distance.push_back(input.distance);
    pressed.push_back(input.is_pressed ? 1 : 0);
  }
  file.write("/inputs/name", names);
  file.write("/inputs/distance", distance, "m");
  file.write("/inputs/on_ground", pressed);
}

void write_output(support::Hdf5Writer& file, const ResponseResult& result, std::size_t output) {
  const auto row = static_cast<Eigen::Index>(output);
  const std::string group = "/outputs/" + result.names[output], &unit = result.units[output];
  const std::size_t m = result.frequency_hz.size(), k = result.inputs.size();
  Eigen::MatrixXd response(static_cast<Eigen::Index>(m), 2);
  response.col(0) = result.response.row(row).real().transpose();
  response.col(1) = result.response.row(row).imag().transpose();
  file.write(group + "/response", response, per_metre(unit));
  std::vector<double> transfer;
  for (const Eigen::MatrixXcd& at_frequency : result.transfer) {
    for (const std::complex<double>& value : at_frequency.row(row)) {
      transfer.insert(transfer.end(), {value.real(), value.imag()});
    }
  }
  file.write(group + "/transfer", transfer, {m, k, 2}, per_metre(unit));
  file.attribute(group, "unit", unit);
  if (!result.has_road()) return;
  file.write(group + "/spectrum", Eigen::VectorXd(result.spectrum.row(row).transpose()),
             "(" + unit + ")^2/Hz");
  file.attribute(group, "rms", result.rms[row]);
}

}  // namespace

void write_response(const std::filesystem::path& path, const ResponseResult& result) {
  support::Hdf5Writer file(path);
  file.attribute("/", "format", kResponseFormat);
  file.attribute("/", "version", std::int64_t{1});
  file.attribute("/", "title", result.vehicle.name);
  file.attribute("/", "units", "SI");
  file.attribute("/", "speed", result.run.speed);
  file.write("/frequency", result.frequency_hz, "Hz");
  write_inputs(file, result);
  if (result.has_road()) {
    file.write("/road/spectrum", result.road_spectrum, "m^2/Hz");
    file.attribute("/road", "rms", result.road_rms);
  }
  for (std::size_t i = 0; i < result.names.size(); ++i) write_output(file, result, i);
  file.make_group("/model");
  file.write("/model/run_text", std::vector<std::string>{result.run.text});
  file.write("/model/vehicle_text", std::vector<std::string>{result.vehicle.text});
  file.write("/model/overrides", result.overrides);
  write_warnings(file, result.warnings);
  file.write("/remarks", result.remarks);
  file.commit();
}

}  // namespace sprung::dynamics
