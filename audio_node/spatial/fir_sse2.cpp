// Available on every 64-bit x86; compilers of other machines use their own vector instructions.
#define TACTUS_FIR sse2
#define TACTUS_FIR_WIDTH 4
#include "audio_node/spatial/fir_loop.h"
