// The commands of sprung-dynamics inside a Python process. The package tools/sprung_tools/programs uses it.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "dynamics/program/command_line.h"
#include "tools/support/terminal/program.h"

namespace py = pybind11;

namespace {

// Text that is written to a stream in memory.
class Text {
 public:
  Text() : stream_(open_memstream(&data_, &size_)) {
    if (!stream_) throw std::bad_alloc();
  }
  ~Text() {
    std::fclose(stream_);
    std::free(data_);
  }
  Text(const Text&) = delete;
  Text& operator=(const Text&) = delete;
  std::FILE* stream() { return stream_; }
  py::bytes bytes() {
    std::fflush(stream_);
    return {data_, size_};
  }

 private:
  char* data_ = nullptr;
  std::size_t size_ = 0;
  std::FILE* stream_;
};

// The exit code, standard output and standard error of a command. Python's lock is held all the while,
// because HDF5 serves one thread at a time, and h5py may be at work in another.
py::tuple call(const std::vector<std::string>& arguments) {
  static sprung::dynamics::SuperelementCache superelements;
  Text out, err;
  sprung::dynamics::RunRequest request;
  request.streams = {out.stream(), err.stream()};
  request.superelements = &superelements;
  request.earlier_cpu_time = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  // Python's handlers of signals run in between; what they throw ends the command.
  const int code = sprung::support::run_inside(
      "sprung-dynamics", request.streams, [] { return PyErr_Occurred() || PyErr_CheckSignals() != 0; },
      [&] { return sprung::dynamics::run_arguments(arguments, request); });
  if (PyErr_Occurred()) throw py::error_already_set();
  return py::make_tuple(code, out.bytes(), err.bytes());
}

}  // namespace

PYBIND11_MODULE(sprung_dynamics, module) {
  module.doc() = "The commands of sprung-dynamics, inside this process.";
  module.def(
      "call", &call, py::arg("arguments"),
      "Does what the arguments of sprung-dynamics ask for. Returns its exit code, and the bytes that it "
      "would print on standard output and standard error.");
}
