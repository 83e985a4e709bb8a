#include "sim_node/run.h"

int main(int argc, char** argv) { return tactus::sim::run(argc, argv); }
