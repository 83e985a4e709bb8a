#include "tests/run_tests.h"

int main(int argc, char** argv) { return tactus::run_tests(argc, argv); }

// The leak sanitizer does not report memory that libraries of the system keep until the process ends.
#if defined(__SANITIZE_ADDRESS__)

extern "C" {

const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
const char* __lsan_default_suppressions() {
  return "leak:libfontconfig\n"
         "leak:libEGL\n"
         "leak:libGLX\n"
         "leak:swrast_dri\n"
         "leak:libgallium\n"
         "leak:libLLVM\n";
}

// Libraries stay loaded, so that what they keep is found under their names.
int dlclose(void*);
int dlclose(void*) { return 0; }
}

#endif
