#include "audio_node/run.h"

int main(int argc, char** argv) { return tactus::audio::run(argc, argv); }
