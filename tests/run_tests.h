// Catch2's runner, compiled once for all test programs.
#pragma once

namespace tactus {

// Runs the tests that the command line selects. Returns the exit status.
int run_tests(int argc, char** argv);

}  // namespace tactus
