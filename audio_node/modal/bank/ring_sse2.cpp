// What every 64-bit x86 has; any other machine's compiler makes of it what that has.
#define TACTUS_RING sse2
#define TACTUS_RING_WIDTH 4
#include "audio_node/modal/bank/ring_loop.h"
