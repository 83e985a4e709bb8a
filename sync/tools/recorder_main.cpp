#include "sync/tools/recorder/recorder_node.h"

int main(int argc, char** argv) { return tactus::sync::run_recorder(argc, argv); }
