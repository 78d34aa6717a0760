#pragma once

// Strict HDF5 input and output: every dataset checksummed, equal calls give equal bytes.
#include "tools/support/hdf5/hdf5_reader.h"
#include "tools/support/hdf5/hdf5_writer.h"
