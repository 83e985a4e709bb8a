// Which instructions the collision layers may use. All paths give the same results to the bit.
#pragma once

#include <string_view>

namespace tactus::sim {

enum class Isa { kBaseline, kAvx2, kAvx512 };

// The best that this processor has. Reads the processor once.
Isa best_isa();

// "auto", "baseline", "avx2", "avx512". Throws std::runtime_error with one sentence when the name is unknown or
// the processor lacks it.
Isa isa_named(std::string_view name);
std::string_view name_of(Isa isa);

}  // namespace tactus::sim
