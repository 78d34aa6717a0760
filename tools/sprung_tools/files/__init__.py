"""Files that the tools read and write: HDF5 files of the project's formats, and whole files of any kind."""
