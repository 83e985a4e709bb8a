#include "audio_node/spatial/fir.h"

#include <stdexcept>

namespace tactus::audio {
namespace sse2 {
void fir(const float*, const float* const*, int, int, float* const*);
}
#if defined(__x86_64__)
namespace avx2 {
void fir(const float*, const float* const*, int, int, float* const*);
}
namespace avx512 {
void fir(const float*, const float* const*, int, int, float* const*);
}
#endif

Fir fir(Instructions instructions) {
#if defined(__x86_64__)
  if (instructions == Instructions::kAvx2) return avx2::fir;
  if (instructions == Instructions::kAvx512) return avx512::fir;
#endif
  if (instructions != Instructions::kSse2) throw std::logic_error("this machine does not have these instructions");
  return sse2::fir;
}

}  // namespace tactus::audio
