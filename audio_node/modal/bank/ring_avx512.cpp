// Compiled with fused multiply-add; CMakeLists.txt sets the flags.
#if defined(__x86_64__)
#define TACTUS_RING avx512
#define TACTUS_RING_WIDTH 16
#include "audio_node/modal/bank/ring_loop.h"
#endif
