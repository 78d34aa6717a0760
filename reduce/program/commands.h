#pragma once

#include <filesystem>
#include <vector>

#include "reduce/design/design.h"

namespace sprung::reduce {

struct BuildOptions {
  std::vector<std::filesystem::path> designs;
  std::filesystem::path output_dir = ".";
  std::vector<std::string> overrides = {};  ///< of values of the designs, as `--set` takes them
  bool force = false;  ///< make files again that are up to date, and replace files that are no superelement
  bool quiet = false;  ///< errors only
};

struct SensitivityOptions {
  DesignSource design;
  int num_modes = 6;  ///< free and clamped ones
  bool json = false;
};

struct SweepCommand {
  DesignSource design;
  std::string vary;  ///< KEY=FROM:TO:STEPS
  int num_modes = 6;
  bool preview = false;
  bool json = false;
};

struct MatricesOptions {
  DesignSource design;
  std::string prefix;  ///< of the files' names
};

struct ExportOptions {
  std::filesystem::path superelement;
  std::string target;  ///< program or format
  std::string prefix;  ///< of the files' names
};

// The subcommands of sprung-reduce. Each returns the program's exit code.

/// Makes `OUTPUT_DIR/STEM.h5` of each design STEM.toml, unless a file is there that verifies and was made
/// from the same design and mesh files by the same revision of the algorithm. A design that cannot be used is
/// reported and the others are made all the same; a file that is there stays whole.
/// @return 0, or that of the first kind of failure: 2 for input, 3 for numerics
/// @throws support::InputError if the folder cannot be used or two designs have one stem
int run_build(const BuildOptions& options);

/// Prints what a file contains. @throws support::InputError
int run_info(const std::filesystem::path& path, bool json);

/// Verifies files. @return 0, or 1 if a check failed, recorded or made again. @throws support::InputError
int run_check(const std::vector<std::filesystem::path>& paths, bool json);

/// Prints how a body changes with the numbers of its design.
/// @throws support::InputError, support::NumericalError
int run_sensitivity(const SensitivityOptions& options);

/// Prints frequencies, mass and inertia while a number of a design takes other values.
/// @throws support::InputError, support::NumericalError
int run_sweep(const SweepCommand& command);

/// Writes K and M of a design's frame as Matrix Market files.
/// @throws support::InputError
int run_matrices(const MatricesOptions& options);

/// Writes a superelement for another program, and prints what its format cannot hold.
/// @throws support::InputError
int run_export(const ExportOptions& options);

/// Prints old and new frequencies and the MAC. @throws support::InputError
int run_diff(const std::filesystem::path& old_path, const std::filesystem::path& new_path, bool json);

}  // namespace sprung::reduce
