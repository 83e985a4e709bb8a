#include "sync/tools/sync_node.h"

int main(int argc, char** argv) { return tactus::sync::run_sync_node(argc, argv); }
