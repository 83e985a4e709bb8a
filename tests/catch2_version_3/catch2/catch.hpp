// Catch2 version 3 under the names of version 2, for which the tests are written. This folder is in the include path only where
// version 3 is installed (tests/CMakeLists.txt); version 2 brings a header of the same name.
#pragma once

#include <catch2/catch_all.hpp>
#include <string>

namespace Catch {

using Matchers::EndsWith;
using Matchers::StartsWith;
using Matchers::UnorderedEquals;

// Matches a string that contains text. Matchers::Contains of version 3 matches an element of a range.
inline Matchers::StringContainsMatcher Contains(const std::string& text) { return Matchers::ContainsSubstring(text); }

}  // namespace Catch

using Catch::Approx;
