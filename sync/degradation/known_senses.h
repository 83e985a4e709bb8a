// The modalities of this repository, and the output operators of a profile that each supports, as declared by their mains. A
// modality of the user's own may have any name and declare any operators.
#pragma once

#include <string>
#include <vector>

namespace tactus::sync {

bool is_known_sense(const std::string& modality);

// The known modalities whose output supports this operator ("frame_rate": visual), separated by commas.
std::string senses_with(const std::string& output_operator);

// The output operators of a known modality; empty for an unknown one.
std::vector<std::string> known_output_operators(const std::string& modality);

}  // namespace tactus::sync
