"""Files that the tools read and write: results and superelements in HDF5, whole files."""
