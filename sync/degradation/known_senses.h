// The senses of this repository, and what of a profile acts on the output of each: their mains declare it. A sense
// of one's own may have any name and declare what it likes.
#pragma once

#include <string>
#include <vector>

namespace tactus::sync {

bool is_known_sense(const std::string& modality);

// The known senses whose output such an operator acts on ("frame_rate": visual), with a comma between them.
std::string senses_with(const std::string& output_operator);

// What acts on the output of a known sense; none of an unknown one.
std::vector<std::string> known_output_operators(const std::string& modality);

}  // namespace tactus::sync
