#include "tests/run_tests.h"

#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include "tests/source_dir.h"

namespace tactus {

int run_tests(int argc, char** argv) { return Catch::Session().run(argc, argv); }

std::string source_dir() { return TACTUS_SOURCE_DIR; }

}  // namespace tactus
