#include "sim_node/collision/layers/isa.h"

#include <stdexcept>
#include <string>

namespace tactus::sim {

Isa best_isa() {
#if defined(__x86_64__)
  static const Isa best = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                                  __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw")
                              ? Isa::kAvx512
                          : __builtin_cpu_supports("avx2") ? Isa::kAvx2
                                                           : Isa::kBaseline;
  return best;
#else
  return Isa::kBaseline;
#endif
}

std::string_view name_of(Isa isa) {
  return isa == Isa::kAvx512 ? "avx512" : isa == Isa::kAvx2 ? "avx2" : "baseline";
}

Isa parse_isa(std::string_view name) {
  if (name == "auto") return best_isa();
  for (const Isa isa : {Isa::kBaseline, Isa::kAvx2, Isa::kAvx512}) {
    if (name != name_of(isa)) continue;
    if (isa > best_isa())
      throw std::runtime_error("sim_node: this processor has no " + std::string(name) + "; choose \"" +
                               std::string(name_of(best_isa())) + "\" or \"auto\"");
    return isa;
  }
  throw std::runtime_error("sim_node: the instruction set \"" + std::string(name) +
                           "\" is unknown; choose auto, baseline, avx2 or avx512");
}

}  // namespace tactus::sim
