#include "visual_node/run.h"

int main(int argc, char** argv) { return tactus::visual::run(argc, argv); }
