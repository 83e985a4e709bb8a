// What every 64-bit x86 has; any other machine's compiler makes of it what that has.
#define TACTUS_FIR sse2
#define TACTUS_FIR_WIDTH 4
#include "audio_node/spatial/fir_loop.h"
