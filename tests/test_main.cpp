#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

#include "tests/source_dir.h"

namespace tactus {

std::string source_dir() { return TACTUS_SOURCE_DIR; }

}  // namespace tactus
