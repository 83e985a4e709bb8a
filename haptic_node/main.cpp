#include "haptic_node/run.h"

int main(int argc, char** argv) { return tactus::haptic::run(argc, argv); }
