#include "audio_node/spatial/fir.h"

#include <stdexcept>

namespace tactus::audio {
namespace sse2 {
void fir_pair(const float*, const float*, const float*, int, float*, float*);
}
#if defined(__x86_64__)
namespace avx2 {
void fir_pair(const float*, const float*, const float*, int, float*, float*);
}
namespace avx512 {
void fir_pair(const float*, const float*, const float*, int, float*, float*);
}
#endif

FirPair fir_pair(Instructions instructions) {
#if defined(__x86_64__)
  if (instructions == Instructions::kAvx2) return avx2::fir_pair;
  if (instructions == Instructions::kAvx512) return avx512::fir_pair;
#endif
  if (instructions != Instructions::kSse2) throw std::logic_error("these instructions are of another machine");
  return sse2::fir_pair;
}

}  // namespace tactus::audio
