#include "thermal_node/devices/display_program.h"

int main(int argc, char** argv) { return tactus::thermal::run_display(argc, argv); }
