// Available on every 64-bit x86; compilers of other machines use their own vector instructions.
#define TACTUS_RING sse2
#define TACTUS_RING_WIDTH 4
#include "audio_node/modal/bank/ring_loop.h"
