// Counts what a thread does that a sound card's callback must not: allocate, lock, wait, read or write. The
// executable that links callback_trap.cpp answers those calls itself, for all libraries too, and passes them on.
#pragma once

#include <string>

namespace tactus::audio::test {

// What this thread does while one lives is counted.
class Trap {
 public:
  Trap();
  ~Trap();
  Trap(const Trap&) = delete;
  Trap& operator=(const Trap&) = delete;
};

// Of all threads so far.
int trapped();
// The first call that was, empty: none.
std::string first_trapped();
void forget_trapped();

// False where a sanitizer answers the calls of the allocator itself.
bool traps_allocation();

}  // namespace tactus::audio::test
