#include "thermal_node/run.h"

int main(int argc, char** argv) { return tactus::thermal::run(argc, argv); }
