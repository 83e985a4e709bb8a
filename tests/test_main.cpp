#include "tests/run_tests.h"

int main(int argc, char** argv) { return tactus::run_tests(argc, argv); }
