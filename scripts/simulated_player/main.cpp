#include "scripts/simulated_player/run.h"

int main(int argc, char** argv) { return tactus::simulated_player::run(argc, argv); }
