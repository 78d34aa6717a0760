// Read by the leak sanitizer where the program is built with it, called by nobody otherwise. HDF5 itself
// loses memory where it opens a damaged object or fails to close a file, which these tests do on purpose;
// leaks of ours still count.

extern "C" {
const char* __lsan_default_suppressions();
const char* __lsan_default_options();

const char* __lsan_default_suppressions() {
  return "leak:libhdf5\n";
}
const char* __lsan_default_options() {
  return "print_suppressions=0";
}
}
