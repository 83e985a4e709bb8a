// The names that somebody may have meant who wrote another.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tactus {

// Up to five of them, nearest first, "a, b or c". A name is the nearer, the fewer letters it takes to change, add
// or leave out (Levenshtein 1966); one that begins with what was written, or holds it, comes before.
std::string spelling_suggestions(std::string_view written, const std::vector<std::string>& names);

}  // namespace tactus
