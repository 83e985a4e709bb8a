// Compiled with fused multiply-add; CMakeLists.txt sets the flags.
#if defined(__x86_64__)
#define TACTUS_FIR avx2
#define TACTUS_FIR_WIDTH 8
#include "audio_node/spatial/fir_loop.h"
#endif
