// Suggestions for a misspelled name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tactus {

// Up to five names, nearest first, "a, b or c". The distance is the number of letters to change, add or leave out
// (Levenshtein 1966); names that begin with or contain the written text come first.
std::string spelling_suggestions(std::string_view written, const std::vector<std::string>& names);

}  // namespace tactus
