// Compiled with fused multiply-add; CMakeLists.txt sets the flags.
#if defined(__x86_64__)
#define TACTUS_RING avx2
#define TACTUS_RING_WIDTH 8
#include "audio_node/modal/bank/ring_loop.h"
#endif
