#include "scripts/trial_runner/run.h"

int main(int argc, char** argv) { return tactus::trial_runner::run(argc, argv); }
