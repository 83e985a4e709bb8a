// Instruction sets of the collision layers. All code paths give bit-identical results.
#pragma once

#include <string_view>

namespace tactus::sim {

enum class Isa { kBaseline, kAvx2, kAvx512 };

// The best instruction set of this processor.
Isa best_isa();

// "auto", "baseline", "avx2", "avx512". Throws std::runtime_error with one sentence when the name is unknown or
// the processor lacks it.
Isa parse_isa(std::string_view name);
std::string_view name_of(Isa isa);

}  // namespace tactus::sim
