#include "scripts/trial_runner/run.h"

int main(int argc, char** argv) { return tactus::conductor::run(argc, argv); }
