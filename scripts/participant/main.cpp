#include "scripts/participant/run.h"

int main(int argc, char** argv) { return tactus::participant::run(argc, argv); }
